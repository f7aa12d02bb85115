"""What a path asks of the joints for the spec's tip force, beside what the motors give."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fpcad.model.equilibrium import least_torque
from fpcad.model.transmission import finger_transmission, single_axis_torque_limits
from fpcad.solve.attempt import Workbench
from fpcad.spec.catalogue import motor
from fpcad.units import NM_PER_NMM
from fpcad.wield.evaluate import build_load
from fpcad.wield.path import WieldingPath

Array = NDArray[np.float64]


@dataclass(frozen=True)
class TorqueDemand:
    """Torques of one pose's path; joints are those of a finger, taken over all fingers."""

    tip_force_n: float
    """Tip force that is asked for [N]."""
    held_tip_force_n: float
    """Tip force that the motors hold along the whole path within their continuous torque [N]."""
    joint_torque_nm: dict[str, float]
    """Largest torque [N m] of each joint at the pose, in the equilibrium with the least torque."""
    path_torque_nm: float
    """Largest joint torque [N m] along the path."""
    motor_joint_torque_nm: dict[str, float]
    """Torque [N m] that the motors give to each joint alone, continuously."""
    motor_torque_nm: float
    """Largest motor torque [N m] at the pose in that equilibrium."""
    continuous_torque_nm: float
    """What one motor gives continuously [N m]."""

    def to_json(self) -> dict[str, Any]:
        """As plain values."""
        return asdict(self)


def torque_demand(bench: Workbench, pose: str, design: Array, path: WieldingPath) -> TorqueDemand:
    """Demand of a pose's path of a hand with design (n_d,) [mm, rad]."""
    load, joints = build_load(bench.spec, pose), bench.template.names.joints
    at_pose = int(np.searchsorted(path.tool_angle_rad, 0.0))
    x = np.concatenate([path.joints_rad[at_pose].ravel(), path.contacts[at_pose].ravel()])
    wrench, torque, tip = bench.kernels[pose].statics(design, path.hand_in_tool, 0.0, x)
    torques = []
    for direction in (1.0, -1.0):
        pull = direction * load.tip_force_n * tip
        holding = least_torque(wrench, torque, pull, load.max_joint_torque_nmm, load.cone_facets)
        if holding is not None:
            torques.append(holding.torque_nmm)
    at_joints = np.abs(torques)
    at_motors = np.abs(np.array(torques) @ load.motor_per_joint_torque.T)
    each = at_joints.reshape(-1, len(joints)).max(axis=0) * NM_PER_NMM
    A = finger_transmission(bench.spec.motors.transmission)
    continuous = motor(bench.spec.motors.type).continuous_torque_nm
    given = single_axis_torque_limits(A, continuous)
    return TorqueDemand(
        tip_force_n=load.tip_force_n,
        held_tip_force_n=float(path.tip_force_n.min()),
        joint_torque_nm=dict(zip(joints, each.tolist(), strict=True)),
        path_torque_nm=float(path.torque_nmm.max()) * NM_PER_NMM,
        motor_joint_torque_nm=dict(zip(joints, given.tolist(), strict=True)),
        motor_torque_nm=float(at_motors.max()) * NM_PER_NMM,
        continuous_torque_nm=continuous,
    )
