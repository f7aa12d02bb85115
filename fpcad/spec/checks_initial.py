"""Checks of the initial hand against the template, the parameter ranges and the poses."""

from __future__ import annotations

import re
from collections.abc import Iterator

from fpcad.spec.base import NAME_PATTERN
from fpcad.spec.faults import KeyPath
from fpcad.spec.hand import ParameterRange
from fpcad.spec.names import check_exact_keys, span
from fpcad.spec.parts import INTERVAL, VECTOR3, Finding, Parts
from fpcad.spec.templates import TemplateNames

ANGLE_TOLERANCE_DEG = 1e-3
"""Joint angles of an initial pose are written with few digits and often lie at a limit."""
RELATIVE_TOLERANCE = 1e-9


def check_initial(parts: Parts, names: TemplateNames) -> Iterator[Finding]:
    """Findings of the `initial` section, if there is one."""
    if parts.keys(("initial",)) is None:
        return
    yield from _check_design(parts, names)
    poses = parts.keys(("poses",))
    if not poses:
        return
    root = ("initial", "poses")
    if all(re.fullmatch(NAME_PATTERN, pose) for pose in poses):  # else told at the pose
        yield from check_exact_keys(parts, root, poses, "a solution of that pose")
    for pose in parts.keys(root) or ():
        if pose in poses:
            yield from _check_joints(parts, (*root, pose), names)
            yield from _check_contacts(parts, pose, names)


def _check_design(parts: Parts, names: TemplateNames) -> Iterator[Finding]:
    root = ("initial", "design")
    yield from check_exact_keys(parts, root, names.parameters, "a number")
    for path, name, value in parts.entries(root, float):
        declared = parts.get(("hand", "parameters", name), ParameterRange)
        if declared is None:
            continue
        low, high = declared.bounds
        slack = RELATIVE_TOLERANCE * max(abs(low), abs(high))
        if not low - slack <= value <= high + slack:
            yield Finding(path, f"a number in the parameter's range {span((low, high))}")


def _check_joints(parts: Parts, pose: KeyPath, names: TemplateNames) -> Iterator[Finding]:
    root = (*pose, "joints_deg")
    yield from check_exact_keys(parts, root, names.fingers, "a list of 3 numbers")
    for path, finger, angles in parts.entries(root, VECTOR3):
        if finger not in names.fingers:
            continue
        for i, (joint, angle) in enumerate(zip(names.joints, angles, strict=True)):
            limits = parts.get(("hand", "joint_limits_deg", joint), INTERVAL)
            if limits is None:
                continue
            if not limits[0] - ANGLE_TOLERANCE_DEG <= angle <= limits[1] + ANGLE_TOLERANCE_DEG:
                yield Finding((*path, i), f"{joint} inside its limits {span(limits)}")


def _check_contacts(parts: Parts, pose: str, names: TemplateNames) -> Iterator[Finding]:
    """The fingers of the initial contacts are those of the pose, in its order."""
    root = ("initial", "poses", pose, "contacts")
    wanted, given = _fingers(parts, ("poses", pose, "contacts")), _fingers(parts, root)
    if not wanted or given is None or not set(wanted) <= set(names.fingers):
        return  # told at the pose or at the contact
    if wanted != given:
        found = "contacts of " + (", ".join(given) or "no finger")
        yield Finding(root, f"contacts of {', '.join(wanted)}, in this order", found)


def _fingers(parts: Parts, contacts: KeyPath) -> list[str] | None:
    """Fingers of a list of contacts, None where one of them is not sound."""
    fingers = [parts.get((*path, "finger"), str) for path in parts.positions(contacts)]
    sound = [finger for finger in fingers if finger is not None]
    return sound if len(sound) == len(fingers) else None
