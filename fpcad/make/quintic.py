"""Quintic Hermite splines over time, and how much of the limits of motion they use."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BPoly

Array = NDArray[np.float64]
Offset = Callable[[Array], Array]
"""Turns (N,) [rad] of the tool -> how far a grip's goals (N, n_joints) [rad] lie beyond the joints."""

PIECES = 8
"""Pieces that a segment is cut into to bound it: the bound's excess falls with their square."""


@dataclass(frozen=True)
class MotionLimits:
    """Largest magnitudes; the joints' are (n_joints,)."""

    tool_speed: float
    """[rad/s]"""
    joint_speed: Array
    """[rad/s]"""
    joint_acceleration: Array
    """[rad/s^2]"""
    offset_speed: float = np.inf
    """Of the grip's goals against the joints [rad/s]."""


class Motion(NamedTuple):
    """Knots of a motion: N instants."""

    time: Array  # (N,) [s], from 0
    turn: Array  # (N,) [rad] of the tool
    position: Array  # (N, n_joints) [rad]
    velocity: Array  # (N, n_joints) [rad/s]
    acceleration: Array  # (N, n_joints) [rad/s^2]

    def joints(self) -> BPoly:
        """Quintics over time [s] in Bernstein form: (n_joints,) [rad]."""
        return quintics(self.time, self.position, self.velocity, self.acceleration)


def quintics(time: Array, position: Array, velocity: Array, acceleration: Array) -> BPoly:
    """Quintic Hermite splines over time (N,), from knots (N, n_joints), in Bernstein form."""
    return BPoly.from_derivatives(time, np.stack([position, velocity, acceleration], axis=1))


def pressure(motion: Motion, limits: MotionLimits, offset: Offset | None = None) -> Array:
    """How hard each segment presses on the limits, (N - 1,) [-]; up to 1 they hold throughout.

    It is the factor by which the squared pace is too high: acceleration over its limit, or speed
    over its limit, squared. A polynomial lies between its least and greatest Bernstein coefficient,
    so the figure is never too low; cutting each segment into pieces makes it hardly too high. The
    grip's goals go evenly from knot to knot.
    """
    joints, steps = motion.joints(), np.diff(motion.time)
    shares = np.arange(PIECES) / PIECES
    fine = np.append((motion.time[:-1, None] + steps[:, None] * shares).ravel(), motion.time[-1])
    pieces = quintics(fine, joints(fine), joints(fine, 1), joints(fine, 2))
    speed = (np.abs(pieces.derivative().c) / limits.joint_speed).max(axis=(0, 2)) ** 2
    acceleration = (np.abs(pieces.derivative(2).c) / limits.joint_acceleration).max(axis=(0, 2))
    even = np.abs(np.diff(motion.turn)) / limits.tool_speed
    if offset is not None:
        goals = np.abs(np.diff(offset(motion.turn), axis=0)).max(axis=1)
        even = np.maximum(even, goals / limits.offset_speed)
    joint = np.maximum(speed, acceleration).reshape(-1, PIECES).max(axis=1)
    return np.maximum(joint, (even / steps) ** 2)


def slowed(motion: Motion, factor: float) -> Motion:
    """The same motion in `factor` times the time."""
    return motion._replace(
        time=motion.time * factor,
        velocity=motion.velocity / factor,
        acceleration=motion.acceleration / factor**2,
    )
