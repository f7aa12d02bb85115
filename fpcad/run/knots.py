"""From a trajectory's knots to those on the wire: spacing, whole microseconds, fixed point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.run.errors import TrajectoryError
from fpcad.run.limits import COUNTS_PER_UNIT, JointLimits, from_counts, to_counts
from fpcad.run.messages import Knot
from fpcad.run.quintic import Array, Knots, evaluate

LONGEST_STEP_S = 0.040
"""25 knots a second: 164 bytes each, 36 % of 115200 baud."""
SHORTEST_STEP_S = 0.004
"""One tick of the controller."""
WINDOW_KNOTS, WINDOW_S = 32, 0.8
"""So many knots, a controller's buffer, must last so long: 40 a second, what a 115200 baud line
carries with one knot on the way at a time and room for repeats."""
WIRE_TOLERANCE_RAD = 1e-4
"""Largest error that thinning a dense file may make; 5 um at 50 mm."""


@dataclass(frozen=True)
class WireKnots:
    """What is sent, and how far it is from what the file says."""

    messages: tuple[Knot, ...]
    error_rad: float
    """Largest distance between the file's motion and the one on the wire, between knots too."""

    @property
    def duration_us(self) -> int:
        """Time of the last knot [us]."""
        return self.messages[-1].t_us


def to_wire(knots: Knots) -> WireKnots:
    """Knots as sent.

    The file's own knots are kept, and segments longer than 40 ms are divided; both leave the motion
    as it is but for rounding to 1e-6 rad. A file too dense for the line is sampled anew, evenly.
    """
    time_s = _divided(knots.time_s)
    if _fits_line(time_s):
        return _rounded(knots, time_s)
    count = max(int(np.ceil(knots.time_s[-1] / (WINDOW_S / WINDOW_KNOTS))), 1)
    wire = _rounded(knots, np.linspace(0.0, knots.time_s[-1], count + 1))
    if wire.error_rad > WIRE_TOLERANCE_RAD:
        raise TrajectoryError(
            f"{WINDOW_KNOTS / WINDOW_S:.0f} knots a second, all that the line carries, miss the "
            f"trajectory by {wire.error_rad:.2g} rad; {WIRE_TOLERANCE_RAD:g} is allowed: "
            "run it slower, or smooth it"
        )
    return wire


def from_wire(messages: tuple[Knot, ...]) -> Knots:
    """Knots as the controller understands them."""
    return Knots(
        np.array([knot.t_us for knot in messages]) / 1e6,
        np.array([from_counts(knot.position_urad) for knot in messages]),
        np.array([from_counts(knot.velocity_urad_s) for knot in messages]),
        np.array([from_counts(knot.acceleration_urad_s2) for knot in messages]),
    )


def approach(present_rad: Array, knots: Knots, limits: JointLimits, share: float) -> Knots:
    """The knots with a slow straight move from the present posture (n,) put in front.

    The move takes `share` of the velocity and acceleration limits, at rest at both ends.
    """
    distance = np.abs(knots.position[0] - present_rad)
    # A quintic from rest to rest peaks at 15/8 of its mean velocity and at 10/sqrt(3) d/T^2.
    by_velocity = 15 / 8 * distance / (share * limits.velocity_rad_s)
    by_acceleration = np.sqrt(10 / np.sqrt(3) * distance / (share * limits.acceleration_rad_s2))
    duration = max(float(by_velocity.max()), float(by_acceleration.max()), LONGEST_STEP_S)
    if distance.max() * COUNTS_PER_UNIT < 1:
        return knots
    still = np.zeros((1, len(present_rad)))
    return Knots(
        np.concatenate([[0.0], knots.time_s + duration]),
        np.vstack([present_rad, knots.position]),
        np.vstack([still, knots.velocity]),
        np.vstack([still, knots.acceleration]),
    )


def _fits_line(time_s: Array) -> bool:
    """Whether knots at these times (N,) are neither too close nor too many."""
    spans = time_s[WINDOW_KNOTS:] - time_s[:-WINDOW_KNOTS]
    return bool(np.diff(time_s).min() >= SHORTEST_STEP_S and (spans >= WINDOW_S).all())


def _divided(time_s: Array) -> Array:
    parts = np.ceil(np.diff(time_s) / LONGEST_STEP_S * (1 - 1e-9)).astype(int)
    inner = [
        np.linspace(start, end, count, endpoint=False)
        for start, end, count in zip(time_s[:-1], time_s[1:], np.maximum(parts, 1), strict=True)
    ]
    return np.concatenate([*inner, time_s[-1:]])


def _rounded(knots: Knots, time_s: Array) -> WireKnots:
    t_us: NDArray[np.int64] = np.rint(time_s * 1e6).astype(np.int64)
    # Sampled at the rounded time, so that rounding time costs no position.
    motion = evaluate(knots, np.minimum(t_us / 1e6, knots.time_s[-1]))
    rows = (motion.position, motion.velocity, motion.acceleration)
    for row, given in zip(rows, (knots.position, knots.velocity, knots.acceleration), strict=True):
        row[-1] = given[-1]  # at rest exactly, though the last time was rounded
    messages = tuple(
        Knot(int(t), to_counts(p), to_counts(v), to_counts(a))
        for t, p, v, a in zip(t_us, *rows, strict=True)
    )
    wire = from_wire(messages)
    fine = np.linspace(0.0, min(wire.time_s[-1], knots.time_s[-1]), 8 * len(time_s) + 1)
    error = evaluate(wire, fine).position - evaluate(knots, fine).position
    return WireKnots(messages, float(np.abs(error).max()))
