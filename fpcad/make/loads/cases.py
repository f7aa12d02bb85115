"""The forces at the contacts that loads are computed for: gripping, with a force at the tip, and the most."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fpcad.make.grip import ContactLink, Grip
from fpcad.make.preload.margins import shared_out
from fpcad.make.preload.plan import grip_preload, tip_wrench
from fpcad.make.preload.stiffness import hand_stiffness
from fpcad.make.preload.touch import FORCE_AXES, Touch, touch
from fpcad.make.trajectory import Trajectory
from fpcad.model.equilibrium import greatest_load, least_torque
from fpcad.model.geometry import HandGeometry
from fpcad.model.statics import cone_facets
from fpcad.spec.catalogue import motor
from fpcad.spec.schema import Spec
from fpcad.units import M_PER_MM, NM_PER_NMM

Array = NDArray[np.float64]
Rows = NDArray[np.int_]

GRIPPING = "gripping"
"""The grip preload alone."""
WITH_TIP = "1 N at the tip"
"""The same with 1 N at the tip, shared out by the fingers' stiffness; both directions."""
MOST = "most at the tip"
"""The greatest tip force that the motors hold continuously, by the best of all forces, as in `tip_force_n`."""

DIRECTIONS = (1.0, -1.0)
NEAR_POSE_RAD = 1e-9
INSIDE = 1.0 - 1e-6
"""Share of the greatest load whose forces are told: at the limit itself rounding decides."""


@dataclass(frozen=True)
class Case:
    """Contact forces of N states of one pose's trajectory."""

    pose: str
    name: str
    angle_rad: Array
    """(N,) turn of the tool."""
    joints_rad: Array
    """(N, n_u) finger by finger."""
    links: tuple[ContactLink, ...]
    points_mm: Array
    """(N, n, 3) contacts in H."""
    forces_n: Array
    """(N, n, 3) with which the fingers push the tool, in H."""
    torque_nmm: Array
    """(N, n_u) joint torques that do so."""
    tip_force_n: Array
    """(N,) force at the tool's tip that is held."""


def grip_cases(spec: Spec, geometry: HandGeometry, pose: str, trajectory: Trajectory) -> list[Case]:
    """The cases of a trajectory, at each of its knots that has a tool angle of its own."""
    grip = grip_of(spec, geometry, pose, trajectory)
    angles, first = np.unique(trajectory.tool.angle_rad, return_index=True)
    joints = trajectory.position_rad[first]
    contacts = touch(grip, joints, angles)
    planned = grip_preload(spec, grip, joints, angles).forces_n.reshape(len(angles), -1)
    tip = tip_wrench(grip, contacts, angles)
    change = shared_out(contacts, hand_stiffness(spec), tip)

    def case(name: str, rows: Rows, forces: Array, held: Array) -> Case:
        axes = contacts.axes[rows]
        in_palm = np.einsum("knij,knj->kni", axes, forces.reshape(*axes.shape[:2], FORCE_AXES))
        torque = np.einsum("kuf,kf->ku", contacts.torque_map[rows], forces)
        where = angles[rows], joints[rows], grip.contacts, contacts.points_mm[rows]
        return Case(pose, name, *where, in_palm, torque, held)

    every = np.arange(len(angles))
    both = np.concatenate([planned + sign * change for sign in DIRECTIONS])
    rows, most, held = _greatest(spec, contacts, tip, angles)
    return [
        case(GRIPPING, every, planned, np.zeros(len(every))),
        case(WITH_TIP, np.tile(every, 2), both, np.ones(2 * len(every))),
        case(MOST, rows, most, held),
    ]


def grip_of(spec: Spec, geometry: HandGeometry, pose: str, trajectory: Trajectory) -> Grip:
    """The grip that a trajectory's file tells: its first knot holds the tool at the pose itself."""
    at_pose = int(np.argmin(np.abs(trajectory.tool.angle_rad)))
    row = trajectory.tool.pose_palm[at_pose]
    R_o_palm = Rotation.from_quat(row[3:], scalar_first=True).inv()
    yaw, pitch, roll = R_o_palm.as_euler("ZYX")
    hand_in_tool = np.concatenate([-R_o_palm.apply(row[:3] / M_PER_MM), [roll, pitch, yaw]])
    turning = spec.poses[pose].turning
    return Grip(geometry, spec.tool, turning, hand_in_tool, trajectory.contacts)


def _greatest(spec: Spec, contacts: Touch, tip: Array, angles: Array) -> tuple[Rows, Array, Array]:
    """States (m,), forces (m, 3n) and greatest tip forces (m,) while the tool turns away from its pose.

    At the pose itself it may turn either way.
    """
    facets, friction = cone_facets(spec.statics), spec.statics.friction
    count = contacts.points_mm.shape[1]
    units = np.tile([1.0, friction, friction], count)
    A = hand_stiffness(spec).A
    limit = np.full(len(A), motor(spec.motors.type).continuous_torque_nm / NM_PER_NMM)
    rows, forces, held = [], [], []
    for sign in DIRECTIONS:
        for k in np.flatnonzero(sign * angles >= -NEAR_POSE_RAD):
            wrench = contacts.grasp_map[k] * units
            motors = np.linalg.solve(A.T, contacts.torque_map[k] * units)
            most = INSIDE * greatest_load(wrench, motors, sign * tip[k], limit, facets)
            found = least_torque(wrench, motors, most * sign * tip[k], float(limit[0]), facets)
            rows.append(int(k))
            held.append(most)
            forces.append(np.zeros(len(units)) if found is None else found.forces_n * units)
    return np.array(rows), np.array(forces), np.array(held)
