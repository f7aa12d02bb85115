"""How far and how fast each motor turns along a trajectory, between its knots too."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PPoly

from fpcad.make.quintic import quintics
from fpcad.make.trajectory import Trajectory

Array = NDArray[np.float64]


class MotorMotion(NamedTuple):
    """Extremes of n motors over a whole trajectory, preload included."""

    low_rad: Array  # (n,)
    high_rad: Array  # (n,)
    speed_rad_s: Array  # (n,) largest magnitude


def motor_motion(trajectory: Trajectory, A: Array) -> MotorMotion:
    """What a trajectory commands its motors; A (n_motors, n_joints) turns joint angles into motors'."""
    angle = motor_commands(trajectory, A)
    low, high = extremes(angle)
    slow, fast = extremes(angle.derivative())
    return MotorMotion(low, high, np.maximum(-slow, fast))


def motor_commands(trajectory: Trajectory, A: Array) -> PPoly:
    """Motor angles (n_motors,) [rad] over time [s] as they are commanded.

    A motor follows the joints' quintics; its preload, a difference at each knot, is linear between.
    """
    at_knots = (
        trajectory.position_rad,
        trajectory.velocity_rad_s,
        trajectory.acceleration_rad_s2,
    )
    motors = quintics(trajectory.time_s, *(values @ A.T for values in at_knots))
    commands = PPoly.from_bernstein_basis(motors)
    if trajectory.position_preload_rad is not None:
        ahead = (trajectory.position_preload_rad - trajectory.position_rad) @ A.T
        commands.c[-1] += ahead[:-1]
        commands.c[-2] += np.diff(ahead, axis=0) / np.diff(trajectory.time_s)[:, None]
    return commands


def extremes(curve: PPoly) -> tuple[Array, Array]:
    """Least and greatest value (n,) of each of n piecewise polynomials, at knots and between them."""
    steps = np.diff(curve.x)[:, None]
    last = np.zeros_like(curve.c[0])
    for coefficient in curve.c:  # Horner; a piece's own end, for pieces may jump at knots
        last = last * steps + coefficient
    low, high = (f(np.stack([curve.c[-1], last]), axis=(0, 1)) for f in (np.min, np.max))
    turning = curve.derivative().roots(discontinuity=False, extrapolate=False)
    for k, times in enumerate(turning):
        times = times[np.isfinite(times)]  # where a motor rests, no single time is told
        if len(times):
            values = curve(times)[:, k]
            low[k], high[k] = min(low[k], values.min()), max(high[k], values.max())
    return low, high
