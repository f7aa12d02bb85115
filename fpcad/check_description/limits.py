"""Limits of joints: there, in order, and possible for a hand or arm of this weight."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fpcad.check_description.check import Fault
from fpcad.check_description.package import Package
from fpcad.check_description.urdf import Joint, Limit, Urdf

LARGEST_RANGE_RAD = 13.0
"""Two turns, however they were rounded."""
LARGEST_SPEED = 100.0
"""rad/s or m/s."""
GRAVITY_M_S2 = 9.81
LARGEST_LOAD_FACTOR = 2_000.0
"""Torque over what holds all links beyond the joint stretched out against gravity [-]."""


def limits(_: Package, robot: Urdf) -> Iterator[Fault]:
    """Missing, empty, or absurd ranges, speeds and torques; soft limits outside hard ones."""
    for joint in robot.moving():
        subject = f"joint {joint.name}"
        if abs(np.linalg.norm(joint.axis) - 1.0) > 1e-6:
            yield Fault(subject, f"its axis has the length {np.linalg.norm(joint.axis):.6g}, not 1")
        if joint.limit is not None:
            yield from (Fault(subject, message) for message in _wrong(joint, joint.limit))
        elif joint.type in ("revolute", "prismatic"):
            yield Fault(subject, "has no limit")


def _wrong(joint: Joint, limit: Limit) -> Iterator[str]:
    if joint.type in ("revolute", "prismatic"):
        if not limit.lower < limit.upper:
            yield f"its range [{limit.lower:g}, {limit.upper:g}] is empty"
        elif joint.type == "revolute" and limit.upper - limit.lower > LARGEST_RANGE_RAD:
            yield f"its range of {limit.upper - limit.lower:.4g} rad is more than two turns: degrees?"
        if limit.soft is not None and not (
            limit.lower <= limit.soft[0] < limit.soft[1] <= limit.upper
        ):
            yield f"its soft limits {limit.soft} are not inside [{limit.lower}, {limit.upper}]"
    if not limit.effort > 0:
        yield f"its effort is {limit.effort:g}"
    if not 0 < limit.velocity <= LARGEST_SPEED:
        yield f"its velocity is {limit.velocity:g}; plausible are 0 to {LARGEST_SPEED:g}"


def effort(_: Package, robot: Urdf) -> Iterator[Fault]:
    """Efforts that have nothing to do with the robot, as placeholders have."""
    for joint in robot.moving():
        if joint.limit is None or joint.type == "prismatic" or not joint.limit.effort > 0:
            continue
        needed = GRAVITY_M_S2 * _stretched_moment(robot, joint, set())
        if 0 < needed * LARGEST_LOAD_FACTOR < joint.limit.effort:
            yield Fault(
                f"joint {joint.name}",
                f"its effort of {joint.limit.effort:g} N m is {joint.limit.effort / needed:.2g} "
                f"times what holds its own links up; a placeholder?",
            )


def _stretched_moment(robot: Urdf, joint: Joint, seen: set[str], reach: float = 0.0) -> float:
    """Sum [kg m] of mass times distance of all links beyond a joint, stretched out straight."""
    if joint.child in seen:  # a circle; the tree's own check tells
        return 0.0
    seen.add(joint.child)
    moment = 0.0
    for link in robot.links:
        if link.name == joint.child and link.inertial is not None:
            arm = reach + float(np.linalg.norm(link.inertial.centre))
            moment += link.inertial.mass * arm
    for follower in robot.joints:
        if follower.parent == joint.child:
            further = reach + float(np.linalg.norm(follower.pose[:3, 3]))
            moment += _stretched_moment(robot, follower, seen, further)
    return moment
