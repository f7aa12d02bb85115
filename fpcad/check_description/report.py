"""All checks of a package, and what they found."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from fpcad.check_description import agreement, inertias, limits, surfaces, tree
from fpcad.check_description.check import Check, Fault, NotApplicableError
from fpcad.check_description.package import Package
from fpcad.check_description.urdf import UnreadableError

READABLE = ("readable", "the file can be read, and its numbers are numbers")
CHECKS = (
    Check("names", "each link and joint has a name of its own", tree.names),
    Check("tree", "joints make one tree of all links", tree.tree),
    Check("meshes", "meshes are where their names say", surfaces.meshes),
    Check("scale", "links are of a robot's size, seen and touched alike", surfaces.scale),
    Check("collision", "what is seen can be touched", surfaces.collision),
    Check(
        "inertia", "moving links have mass, and an inertia that a body can have", inertias.inertia
    ),
    Check("plausible inertia", "mass and inertia fit the shape", inertias.plausible),
    Check("centre", "centres of mass lie inside the shapes' hulls", inertias.centre),
    Check("limits", "ranges, speeds and efforts make sense, soft limits lie inside", limits.limits),
    Check("effort", "efforts are no placeholders", limits.effort),
    Check("MJCF", "MuJoCo models say the same", agreement.mjcf),
    Check("transmission", "transmission.yaml says the same", agreement.transmission),
    Check("joint limits", "joint_limits.yaml says the same", agreement.joint_limits),
)
NEED_MESHES = {"scale", "collision", "plausible inertia", "centre"}
Verdict = Literal["good", "faulty", "skipped"]


@dataclass(frozen=True)
class Row:
    """What one check found in one robot."""

    robot: str
    """Its file, relative to the package."""
    check: str
    rule: str
    verdict: Verdict
    faults: tuple[Fault, ...] = ()
    reason: str = ""
    """Why it was skipped."""


@dataclass(frozen=True)
class Report:
    """All rows of a package."""

    folder: Path
    rows: tuple[Row, ...]

    @property
    def is_good(self) -> bool:
        """Whether no check found a fault."""
        return all(row.verdict != "faulty" for row in self.rows)


def check_description(folder: Path) -> Report:
    """Check every robot of a package; :class:`fpcad.errors.StoreError` where there is none."""
    package = Package(folder)
    rows = [row for urdf in package.urdfs() for row in _rows(package, urdf)]
    return Report(folder, tuple(rows))


def _rows(package: Package, urdf: Path) -> Iterator[Row]:
    name = urdf.relative_to(package.folder).as_posix()
    try:
        robot = package.read(urdf)
    except UnreadableError as error:
        yield Row(name, *READABLE, "faulty", (Fault(urdf.name, str(error)),))
        return
    yield Row(name, *READABLE, "good")
    lacks_meshes = any(surfaces.meshes(package, robot))
    for check in CHECKS:
        about = name, check.name, check.rule
        if lacks_meshes and check.name in NEED_MESHES:
            yield Row(*about, "skipped", reason="meshes are missing")
            continue
        try:
            faults = tuple(check.faults(package, robot))
        except NotApplicableError as reason:
            yield Row(*about, "skipped", reason=str(reason))
        except UnreadableError as error:
            yield Row(*about, "faulty", (Fault(check.name, str(error)),))
        else:
            yield Row(*about, "faulty" if faults else "good", faults)
