"""What the motors are told over time: the exported trajectory, with its preload, in the open loop."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.make.trajectory import Trajectory
from fpcad.model.transmission import motor_angles
from fpcad.simulate.setting import CONTROL_PERIOD_S, Trial

Array = NDArray[np.float64]

CLOSE_S = 0.5
"""Time in which the fingers close on the tool that somebody holds for them."""
GIVE_S = 0.3
"""Time in which the tool is held on, and then let go of."""
REST_S = 0.7
"""Time in which the hand alone holds the tool before it turns it."""
START_S = CLOSE_S + GIVE_S + REST_S
FULL_FORCE_RATE = 0.2
"""Share of the tool's top speed from which the tip force is whole; it is smooth through rest."""


@dataclass(frozen=True)
class Commands:
    """Targets at the control period, from the empty-handed start on; T ticks."""

    motors_rad: Array
    """(T, n_motors)"""
    tip_force_n: Array
    """(T,) force at the tip, positive against a positive turning."""
    planned_angle_rad: Array
    """(T,) where the tool should be."""
    planned_position_m: Array
    """(T, 3) of O in `palm`."""
    let_go: int
    """Tick at which the tool is let go of."""
    start: int
    """Tick at which the trajectory starts."""


def commands(trajectory: Trajectory, A: Array, trial: Trial) -> Commands:
    """Targets of a trial. Grip preload is linear in time between knots, and scaled by the trial."""
    ticks = int(np.ceil(trajectory.duration_s / CONTROL_PERIOD_S)) + 1
    time = np.minimum(np.arange(ticks) * CONTROL_PERIOD_S, trajectory.duration_s)
    joints = trajectory.joints()(time) + trial.preload * _offset(trajectory, time)
    angle = _over_time(trajectory, trajectory.tool.angle_rad[:, None], time)[:, 0]
    position = _over_time(trajectory, trajectory.tool.pose_palm[:, :3], time)
    before = round(START_S / CONTROL_PERIOD_S)
    closing = np.minimum(np.arange(before) * CONTROL_PERIOD_S / CLOSE_S, 1.0)[:, None]
    open_hand = trajectory.position_rad[0]
    closed = open_hand + closing * (joints[0] - open_hand)
    rate = np.gradient(angle, CONTROL_PERIOD_S)
    against = np.tanh(rate / (FULL_FORCE_RATE * max(np.abs(rate).max(), 1e-9)))
    return Commands(
        motors_rad=motor_angles(A, np.vstack([closed, joints])),
        tip_force_n=np.concatenate([np.zeros(before), trial.tip_force_n * against]),
        planned_angle_rad=np.concatenate([np.zeros(before), angle]),
        planned_position_m=np.vstack([np.repeat(position[:1], before, axis=0), position]),
        let_go=round((CLOSE_S + GIVE_S) / CONTROL_PERIOD_S),
        start=before,
    )


def _offset(trajectory: Trajectory, time: Array) -> Array:
    """(T, n_u) how far commands lie ahead of the contact postures [rad]."""
    if trajectory.position_preload_rad is None:
        raise ValueError("the trajectory has no grip preload: export the hand again")
    return _over_time(trajectory, trajectory.position_preload_rad - trajectory.position_rad, time)


def _over_time(trajectory: Trajectory, values: Array, time: Array) -> Array:
    """Values (N, k) at the knots, linear between them, at times (T,)."""
    columns = [np.interp(time, trajectory.time_s, column) for column in values.T]
    return np.stack(columns, axis=1)
