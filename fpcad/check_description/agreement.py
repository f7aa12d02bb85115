"""Several descriptions of one robot say the same: URDF, MJCF and tables in YAML."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fpcad.check_description.check import Fault, NotApplicableError
from fpcad.check_description.package import JOINT_LIMITS, TRANSMISSION, Package
from fpcad.check_description.simulated import Simulated
from fpcad.check_description.urdf import Joint, Urdf

Array = NDArray[np.float64]

PLACE_M = 1e-6
"""Largest difference of places [m] and of rotation matrices' entries [-]."""
SHARE = 1e-6
"""Largest relative difference of masses, inertias, limits and torques [-]."""
POSTURES = 5


def mjcf(package: Package, robot: Urdf) -> Iterator[Fault]:
    """Joints, places, masses, inertias and torques that differ from a MuJoCo model's."""
    for model in _models(package, robot):
        for message in (
            *_joint_differences(model, robot),
            *_place_differences(model, robot),
            *_mass_differences(model, robot),
            *_torque_differences(model, robot),
        ):
            yield Fault(model.file.name, message)


def transmission(package: Package, robot: Urdf) -> Iterator[Fault]:
    """A table of motors and joints that is no transmission, or not the MuJoCo model's."""
    tables = package.tables(TRANSMISSION)
    if not tables:
        raise NotApplicableError(f"no {TRANSMISSION}")
    for file, table in tables:
        matrix = _matrix(file, table)
        if isinstance(matrix, Fault):
            yield matrix
            continue
        if unknown := set(table["joints"]) - {joint.name for joint in robot.moving()}:
            yield Fault(file.name, f"unknown joints: {', '.join(sorted(unknown))}")
        for model in _models(package, robot) if package.mjcfs() else ():
            for message in _matrix_differences(model, table, matrix):
                yield Fault(file.name, f"{model.file.name}: {message}")


def joint_limits(package: Package, robot: Urdf) -> Iterator[Fault]:
    """Limits in a table that are not the URDF's."""
    tables = package.tables(JOINT_LIMITS)
    if not tables:
        raise NotApplicableError(f"no {JOINT_LIMITS}")
    by_name = {joint.name: joint for joint in robot.moving()}
    for file, table in tables:
        rows = table.get("joint_limits", {}) if isinstance(table, dict) else {}
        if not rows:
            yield Fault(file.name, "has no joint_limits")
        for name, row in rows.items():
            if name not in by_name:
                yield Fault(file.name, f"{name} is no moving joint")
            else:
                yield from (Fault(file.name, text) for text in _row_faults(by_name[name], row))


def _models(package: Package, robot: Urdf) -> list[Simulated]:
    wanted = {joint.name for joint in robot.moving() if joint.mimics is None}
    models = [Simulated(file) for file in package.mjcfs()]
    same = [model for model in models if wanted <= model.joints.keys()]
    if not same:
        reason = "has other joints" if models else "is there"
        raise NotApplicableError(f"{'every' if models else 'no'} MuJoCo model {reason}")
    return same


def _joint_differences(model: Simulated, robot: Urdf) -> Iterator[str]:
    for joint in robot.moving():
        other = model.joints.get(joint.name)
        if other is None or joint.limit is None or joint.type == "continuous":
            continue
        for ours, theirs in zip((joint.limit.lower, joint.limit.upper), other.range, strict=True):
            if not math.isclose(ours, theirs, rel_tol=SHARE, abs_tol=1e-9):
                yield f"{joint.name}: a limit is {theirs:.9g}, in the URDF {ours:.9g}"


def _place_differences(model: Simulated, robot: Urdf) -> Iterator[str]:
    shared = [link.name for link in robot.links if link.name in model.bodies]
    random, worst = np.random.default_rng(0), dict.fromkeys(shared, 0.0)
    for _ in range(POSTURES):
        angles = {
            j.name: _within(j, random.uniform()) for j in robot.moving() if j.name in model.joints
        }
        ours, theirs = link_poses(robot, angles), model.poses(angles)
        if not shared or shared[0] not in ours:
            return
        base = theirs[shared[0]] @ np.linalg.inv(ours[shared[0]])
        for link in shared:
            if link in ours:
                difference = float(np.abs(base @ ours[link] - theirs[link]).max())
                worst[link] = max(worst[link], difference)
    for link, difference in worst.items():
        if difference > PLACE_M:
            yield f"{link} lies elsewhere than in the URDF: {difference:.3g} (m, or entries of rotation)"


def _mass_differences(model: Simulated, robot: Urdf) -> Iterator[str]:
    for link in robot.links:
        if link.inertial is None or link.name not in model.bodies:
            continue
        body = model.bodies[link.name]
        mass = float(body.mass[0])
        if not math.isclose(mass, link.inertial.mass, rel_tol=SHARE):
            yield f"{link.name} weighs {mass:.9g} kg, in the URDF {link.inertial.mass:.9g}"
        if np.abs(body.ipos - link.inertial.centre).max() > PLACE_M:
            yield f"{link.name}: its centre of mass is another one than the URDF's"
        tensor = model.inertia(link.name)
        difference = np.abs(tensor - link.inertial.tensor).max() / np.trace(link.inertial.tensor)
        if difference > SHARE:
            yield f"{link.name}: its inertia differs from the URDF's by {difference:.3g} of its trace"


def _torque_differences(model: Simulated, robot: Urdf) -> Iterator[str]:
    """What the motors give each joint alone, against the URDF's effort."""
    joints = [joint for joint in robot.moving() if joint.name in model.joints and joint.limit]
    A = model.motor_matrix([joint.name for joint in joints])
    if A.shape[0] != A.shape[1] or np.linalg.matrix_rank(A) < len(A):
        return  # not one motor for each joint: a box of torques says nothing of the motors
    used = np.abs(np.linalg.inv(A.T))  # torque of each motor for one unit of each joint's
    torques = np.broadcast_to(model.motor_torques()[:, None], used.shape)
    alone = np.divide(torques, used, out=np.full_like(used, np.inf), where=used > 0).min(axis=0)
    for joint, torque in zip(joints, alone, strict=True):
        assert joint.limit is not None
        if not math.isclose(torque, joint.limit.effort, rel_tol=SHARE):
            yield f"{joint.name}: motors give {torque:.6g} N m, effort is {joint.limit.effort:.6g}"


def _matrix(file: Path, table: Any) -> Array | Fault:
    """The matrix of a transmission file, or what is wrong with it."""
    keys = ("matrix", "joints", "motors")
    if not isinstance(table, dict) or any(key not in table for key in keys):
        return Fault(file.name, f"lacks one of the keys {', '.join(keys)}")
    try:
        matrix = np.array(table["matrix"], dtype=float)
    except (TypeError, ValueError):
        return Fault(file.name, "its matrix has entries that are no numbers, or rows unlike")
    expected = len(table["motors"]), len(table["joints"])
    if matrix.shape != expected:
        return Fault(file.name, f"its matrix is {matrix.shape}; motors and joints make {expected}")
    if np.linalg.matrix_rank(matrix) < matrix.shape[1]:
        return Fault(file.name, "its matrix is singular: some motion of the joints moves no motor")
    return matrix


def _matrix_differences(model: Simulated, table: Any, matrix: Array) -> Iterator[str]:
    names = model.motor_names()
    if set(names) != set(table["motors"]):
        yield "its actuators have other names than the motors"
        return
    rows = [names.index(motor) for motor in table["motors"]]
    joints = [name for name in table["joints"] if name in model.joints]
    columns = [list(table["joints"]).index(name) for name in joints]
    difference = np.abs(model.motor_matrix(joints)[rows] - matrix[:, columns])
    for i, j in np.argwhere(difference > SHARE * max(1.0, np.abs(matrix).max())):
        yield f"{table['motors'][i]} moves another way with {joints[j]} than the matrix says"


def _row_faults(joint: Joint, row: Any) -> Iterator[str]:
    if joint.limit is None or not isinstance(row, dict):
        return
    for key, ours in (
        ("min_position", joint.limit.lower),
        ("max_position", joint.limit.upper),
        ("max_velocity", joint.limit.velocity),
        ("max_effort", joint.limit.effort),
    ):
        theirs = row.get(key)
        if theirs is not None and not math.isclose(theirs, ours, rel_tol=SHARE, abs_tol=1e-9):
            yield f"{joint.name}: {key} is {theirs:.9g}, in the URDF {ours:.9g}"


def _within(joint: Joint, share: float) -> float:
    if joint.limit is None or not joint.limit.lower < joint.limit.upper:
        return share
    return joint.limit.lower + share * (joint.limit.upper - joint.limit.lower)


def link_poses(robot: Urdf, joints: dict[str, float]) -> dict[str, Array]:
    """Pose (4, 4) [m] of each link that the first root reaches, in that root."""
    children = {joint.child for joint in robot.joints}
    root = next((link.name for link in robot.links if link.name not in children), None)
    poses = {} if root is None else {root: np.eye(4)}
    waiting = list(robot.joints)
    while ready := [joint for joint in waiting if joint.parent in poses]:
        for joint in ready:
            poses[joint.child] = poses[joint.parent] @ joint.pose @ _moved(joint, joints)
        waiting = [joint for joint in waiting if joint not in ready]
    return poses


def _moved(joint: Joint, joints: dict[str, float]) -> Array:
    pose, travel = np.eye(4), joints.get(joint.name, 0.0)
    if joint.type == "prismatic":
        pose[:3, 3] = travel * joint.axis
    elif joint.is_moving:
        pose[:3, :3] = Rotation.from_rotvec(travel * joint.axis).as_matrix()
    return pose
