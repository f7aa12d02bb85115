"""Links and joints form one tree with names of their own."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from fpcad.check_description.check import Fault
from fpcad.check_description.package import Package
from fpcad.check_description.urdf import Urdf

TYPES = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")


def names(_: Package, robot: Urdf) -> Iterator[Fault]:
    """Names that are missing, used twice, or hold white space."""
    if not robot.name:
        yield Fault("robot", "has no name")
    for kind, members in (("link", robot.links), ("joint", robot.joints)):
        for name, count in Counter(member.name for member in members).items():
            if not name:
                yield Fault(kind, f"{count} without a name")
            elif count > 1:
                yield Fault(f"{kind} {name}", f"the name is used {count} times")
            elif any(c.isspace() for c in name):
                yield Fault(f"{kind} {name!r}", "the name holds white space")


def tree(_: Package, robot: Urdf) -> Iterator[Fault]:
    """Joints that name no link, links with two parents, more than one root, circles."""
    links = {link.name for link in robot.links}
    for joint in robot.joints:
        for end, name in (("parent", joint.parent), ("child", joint.child)):
            if name not in links:
                yield Fault(f"joint {joint.name}", f"its {end} {name!r} is no link")
        if joint.type not in TYPES:
            yield Fault(f"joint {joint.name}", f"there is no type {joint.type!r}")
        if joint.mimics is not None and joint.mimics not in {j.name for j in robot.joints}:
            yield Fault(f"joint {joint.name}", f"it mimics {joint.mimics!r}, which is no joint")
    parents = Counter(joint.child for joint in robot.joints)
    for link, count in parents.items():
        if count > 1:
            yield Fault(f"link {link}", f"is the child of {count} joints")
    roots = [link for link in sorted(links) if link not in parents]
    if len(roots) != 1:
        yield Fault("robot", f"{len(roots)} roots instead of one: {', '.join(roots) or 'a circle'}")
    elif lost := links - _reached(robot, roots[0]):
        yield Fault("robot", f"a circle that the root does not reach: {', '.join(sorted(lost))}")


def _reached(robot: Urdf, root: str) -> set[str]:
    reached, front = {root}, {root}
    while front:
        front = {joint.child for joint in robot.joints if joint.parent in front} - reached
        reached |= front
    return reached
