"""From a trajectory's knots to those on the wire: spacing, whole microseconds, fixed point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.run.errors import TrajectoryError
from fpcad.run.limits import COUNTS_PER_UNIT, JointLimits, from_counts, to_counts
from fpcad.run.messages import PRELOAD_URAD, Knot
from fpcad.run.quintic import Array, Knots, evaluate, preload_at

BUFFER_KNOTS = 64
"""Knots that a controller holds, unless it says otherwise; 10 kB."""
LINE_KNOTS_PER_S = 36.0
"""What a 115200 baud line carries: a knot has 188 bytes, and one is on the way at a time."""
CUSHION_S = 0.5
"""Motion that must be queued at any time, so that a stall of the host does no harm."""
LONGEST_STEP_S = 0.1
SHORTEST_STEP_S = 0.004
"""One tick of the controller."""
THINNED_STEP_S = 0.03
"""Spacing of the knots of a file that is too dense for the line."""
_SHORTEST_APPROACH_S = 0.1
_LARGEST_PRELOAD = 2**15 - 1
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


def to_wire(knots: Knots, buffer_knots: int = BUFFER_KNOTS) -> WireKnots:
    """Knots as sent to a controller that holds `buffer_knots`.

    The file's own knots are kept, and segments longer than 0.1 s are divided; both leave the motion
    as it is but for rounding to 1e-6 rad. A file too dense for the line is sampled anew, evenly.
    """
    time_s = _divided(knots.time_s)
    if _fits_line(time_s, buffer_knots):
        return _rounded(knots, time_s)
    count = max(int(np.ceil(knots.time_s[-1] / THINNED_STEP_S)), 1)
    wire = _rounded(knots, np.linspace(0.0, knots.time_s[-1], count + 1))
    if wire.error_rad > WIRE_TOLERANCE_RAD:
        raise TrajectoryError(
            f"the file has more knots than the line carries, and a knot every "
            f"{THINNED_STEP_S * 1e3:.0f} ms misses its motion by {wire.error_rad:.2g} rad "
            f"({WIRE_TOLERANCE_RAD:g} is allowed): run it slower, or smooth it"
        )
    return wire


def from_wire(messages: tuple[Knot, ...]) -> Knots:
    """Knots as the controller understands them."""
    return Knots(
        np.array([knot.t_us for knot in messages]) / 1e6,
        np.array([from_counts(knot.position_urad) for knot in messages]),
        np.array([from_counts(knot.velocity_urad_s) for knot in messages]),
        np.array([from_counts(knot.acceleration_urad_s2) for knot in messages]),
        np.array([from_counts(knot.preload_20urad) for knot in messages]) * PRELOAD_URAD,
    )


def approach(present_rad: Array, knots: Knots, limits: JointLimits, share: float) -> Knots:
    """The knots with a slow straight move from the present posture (n,) put in front.

    The move takes `share` of the velocity and acceleration limits, at rest at both ends.
    """
    distance = np.abs(knots.position[0] - present_rad)
    # A quintic from rest to rest peaks at 15/8 of its mean velocity and at 10/sqrt(3) d/T^2.
    by_velocity = 15 / 8 * distance / (share * limits.velocity_rad_s)
    by_acceleration = np.sqrt(10 / np.sqrt(3) * distance / (share * limits.acceleration_rad_s2))
    duration = max(float(by_velocity.max()), float(by_acceleration.max()), _SHORTEST_APPROACH_S)
    if distance.max() * COUNTS_PER_UNIT < 1:
        return knots
    still = np.zeros((1, len(present_rad)))
    return Knots(
        np.concatenate([[0.0], knots.time_s + duration]),
        np.vstack([present_rad, knots.position]),
        np.vstack([still, knots.velocity]),
        np.vstack([still, knots.acceleration]),
        None if knots.preload is None else np.vstack([knots.preload[:1], knots.preload]),
    )


def _fits_line(time_s: Array, buffer_knots: int) -> bool:
    """Whether a line keeps a cushion of motion queued when knots lie at these times (N,).

    The buffer is full at the start; from then on a knot arrives when there is room for it and the
    line has carried it.
    """
    if np.diff(time_s).min() < SHORTEST_STEP_S:
        return False
    arrived_s = 0.0
    for i in range(buffer_knots, len(time_s)):
        room_s = time_s[i - buffer_knots + 1]
        arrived_s = max(arrived_s, room_s) + 1 / LINE_KNOTS_PER_S
        if time_s[i - 1] - arrived_s < CUSHION_S:
            return False
    return True


def _divided(time_s: Array) -> Array:
    parts = np.ceil(np.diff(time_s) / LONGEST_STEP_S * (1 - 1e-9)).astype(int)
    inner = [
        np.linspace(start, end, count, endpoint=False)
        for start, end, count in zip(time_s[:-1], time_s[1:], np.maximum(parts, 1), strict=True)
    ]
    return np.concatenate([*inner, time_s[-1:]])


def _preload_counts(preload_rad: Array) -> tuple[int, ...]:
    counts = np.rint(preload_rad * (COUNTS_PER_UNIT / PRELOAD_URAD))
    if not (np.abs(counts) <= _LARGEST_PRELOAD).all():
        raise ValueError(f"a preload of {np.abs(preload_rad).max():.3g} rad does not fit 16 bits")
    return tuple(int(count) for count in counts)


def _rounded(knots: Knots, time_s: Array) -> WireKnots:
    t_us: NDArray[np.int64] = np.rint(time_s * 1e6).astype(np.int64)
    # Sampled at the rounded time, so that rounding time costs no position.
    motion = evaluate(knots, np.minimum(t_us / 1e6, knots.time_s[-1]))
    rows = (motion.position, motion.velocity, motion.acceleration)
    for row, given in zip(rows, (knots.position, knots.velocity, knots.acceleration), strict=True):
        row[-1] = given[-1]  # at rest exactly, though the last time was rounded
    try:
        messages = tuple(
            Knot(int(t), to_counts(p), to_counts(v), to_counts(a), _preload_counts(w))
            for t, p, v, a, w in zip(t_us, *rows, preload_at(knots, t_us / 1e6), strict=True)
        )
    except ValueError as error:
        raise TrajectoryError(f"the trajectory's numbers are too large to send: {error}") from error
    wire = from_wire(messages)
    fine = np.linspace(0.0, min(wire.time_s[-1], knots.time_s[-1]), 8 * len(time_s) + 1)
    error = evaluate(wire, fine).position - evaluate(knots, fine).position
    return WireKnots(messages, float(np.abs(error).max()))
