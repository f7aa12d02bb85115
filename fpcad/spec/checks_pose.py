"""Checks of each foundational pose against the hand template and the tool."""

from __future__ import annotations

import math
from collections.abc import Iterator

from fpcad.spec.faults import KeyPath, one_of
from fpcad.spec.names import span
from fpcad.spec.parts import COST_TERM, Finding, Parts
from fpcad.spec.pose import Contact, JointUse, Turning
from fpcad.spec.templates import TemplateNames
from fpcad.spec.tool import CylinderTool


def check_poses(parts: Parts, names: TemplateNames) -> Iterator[Finding]:
    """Findings of all poses."""
    tool = parts.get(("tool",), CylinderTool)
    for pose in parts.keys(("poses",)) or ():
        path = ("poses", pose)
        yield from _check_contacts(parts, path, names)
        yield from _check_cost(parts, path, names)
        if tool is not None:
            yield from _check_windows_on_tool(parts, path, tool)
            yield from _check_turning(parts, path, tool)


def _check_contacts(parts: Parts, pose: KeyPath, names: TemplateNames) -> Iterator[Finding]:
    touching: dict[tuple[str, str], int] = {}
    for path, contact in parts.items((*pose, "contacts"), Contact):
        if contact is None:
            continue
        if contact.finger not in names.fingers:
            yield Finding((*path, "finger"), one_of(names.fingers, contact.finger))
        if contact.link not in names.links:
            yield Finding((*path, "link"), one_of(names.links, contact.link))
        first = touching.setdefault((contact.finger, contact.link), int(path[-1]))
        if first != path[-1]:
            allowed = f"each link once in a pose (contacts[{first}] has it)"
            yield Finding(path, allowed, f"the {contact.finger}'s {contact.link} link again")
        low, high = contact.angle_deg
        if high - low > 360:
            yield Finding((*path, "angle_deg"), "a window at most 360 wide")


def _check_windows_on_tool(parts: Parts, pose: KeyPath, tool: CylinderTool) -> Iterator[Finding]:
    for path, contact in parts.items((*pose, "contacts"), Contact):
        if contact is None:
            continue
        low, high = contact.axial_mm
        if low < tool.back_mm or high > tool.tip_mm:
            ends = span((tool.back_mm, tool.tip_mm))
            yield Finding((*path, "axial_mm"), f"a window on the tool, inside {ends}")


def _check_cost(parts: Parts, pose: KeyPath, names: TemplateNames) -> Iterator[Finding]:
    contacts = [contact for _, contact in parts.items((*pose, "contacts"), Contact)]
    touching = list(dict.fromkeys(c.finger for c in contacts if c is not None))
    whole = bool(contacts) and None not in contacts and set(touching) <= set(names.fingers)
    for path, term in parts.items((*pose, "cost"), COST_TERM):
        if term is None:
            continue
        if isinstance(term, JointUse):
            if term.joint not in names.joints:
                yield Finding((*path, "joint"), one_of(names.joints, term.joint))
            continue
        for i, finger in enumerate(term.fingers):
            at = (*path, "fingers", i)
            if finger not in names.fingers:
                yield Finding(at, one_of(names.fingers, finger))
            elif whole and finger not in touching:
                yield Finding(at, f"a finger that touches in this pose: {one_of(touching)}")
            elif finger in term.fingers[:i]:
                yield Finding(at, "each finger once")


def _check_turning(parts: Parts, pose: KeyPath, tool: CylinderTool) -> Iterator[Finding]:
    """The tip force opposes the tip's motion, so the turning must move the tip."""
    path = (*pose, "turning")
    turning = parts.get(path, Turning)
    if turning is None:
        return
    (ax, ay, az), (px, py, pz) = turning.axis, turning.pivot_mm
    arm = (tool.tip_mm - px, -py, -pz)
    length = math.hypot(ax, ay, az)
    motion = (
        ay * arm[2] - az * arm[1],
        az * arm[0] - ax * arm[2],
        ax * arm[1] - ay * arm[0],
    )
    if math.hypot(*motion) < 1e-6 * length:
        keys = parts.keys(path) or ()
        at = (*path, "axis") if "axis" in keys else path
        yield Finding(at, "an axis that does not pass through the tool's tip")
