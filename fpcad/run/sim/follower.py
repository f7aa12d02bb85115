"""Follows queued knots in time, and can leave time behind: it slows down along the path."""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray

from fpcad.run.acceptance import first_violation
from fpcad.run.knots import from_wire
from fpcad.run.limits import (
    COUNTS_PER_UNIT,
    PRELOAD_LIMIT_RAD,
    PRELOAD_SPEED_RAD_S,
    JointLimits,
)
from fpcad.run.messages import PRELOAD_URAD, Knot, Reason
from fpcad.run.motor_limits import MotorLimits, first_motor_violation
from fpcad.run.quintic import evaluate_polynomial, segment_coefficients
from fpcad.run.transmission import Transmission

Array = NDArray[np.float64]

START_DISTANCE_RAD = np.radians(2.0)
"""Largest distance between the first knot and where the joints are."""
_STARVING_US = 200_000
"""Path left at which waiting for more knots must end: enough to slow down on."""
_PRELOAD_STEP_RAD = 0.002
"""A preload that differs by less counts as unchanged."""
SEGMENT_US = (3_000, 10_000_000)
"""Shortest and longest segment: a shorter one would be all rounding, a longer one does not fit the
firmware's fixed point."""
_FASTEST_BRAKING = 20.0
"""Largest loss of path rate [1/s]: from full speed to rest in 50 ms where the joints can."""


class PathFollower:
    """Queue of knots and the place on their path. Times in us, joints in rad."""

    def __init__(
        self,
        limits: JointLimits,
        capacity: int,
        position: Array,
        motors: tuple[Transmission, MotorLimits] | None = None,
    ) -> None:
        self._limits = limits
        self._motors = motors
        self._capacity = capacity
        self.rest_at(position)

    def rest_at(self, position: Array) -> None:
        """Forget all knots; the command becomes `position` (n,) at rest, without preload."""
        self.command = np.array(position, dtype=float)
        self.preload = np.zeros_like(self.command)
        self.forget()

    def forget(self) -> None:
        """Forget all knots; command and preload stay as they are."""
        self._knots: deque[Knot] = deque()
        self._segment: Array | None = None
        self._accepted = 0
        self._path_us = 0.0
        self.rate = 0.0
        self.stopping = False
        self.ended = False
        self.command_velocity = np.zeros_like(self.command)

    def error(self, measured: Array, command: Array | None = None) -> Array:
        """How far joints (n,) are from where they may be: from the command to the goal beyond it."""
        ahead = measured - (self.command if command is None else command)
        lower, upper = np.minimum(self.preload, 0), np.maximum(self.preload, 0)
        return np.maximum(np.maximum(lower - ahead, ahead - upper), 0)

    def keep(self, count: int) -> None:
        """Lose all knots but the first ones, as a fault of memory would."""
        while len(self._knots) > count:
            self._knots.pop()

    @property
    def free(self) -> int:
        """Knots that still fit."""
        return self._capacity - len(self._knots)

    @property
    def queued(self) -> int:
        """Knots held, those of the present segment included."""
        return len(self._knots)

    @property
    def path_us(self) -> int:
        """Place on the path as path time [us]."""
        return round(self._path_us)

    @property
    def queued_us(self) -> float:
        """Path time ahead [us]."""
        return self._knots[-1].t_us - self._path_us if self._knots else 0.0

    @property
    def starving(self) -> bool:
        """Whether the path ends soon though its end was not announced."""
        return not self.ended and self.queued_us < _STARVING_US

    @property
    def arrived(self) -> bool:
        """Whether the announced end is reached."""
        return self.ended and self.queued_us <= 0

    def offer(self, knot: Knot, present: Array) -> tuple[Reason, int] | None:
        """Take a knot, or say why not and for which joint; `present` (n,) is measured."""
        refusal = self._refusal(knot, present)
        if refusal is None:
            self._knots.append(knot)
            self._accepted += 1
        return refusal

    def end(self, count: int) -> Reason | None:
        """Take the announcement that `count` knots were all."""
        if count != self._accepted or len(self._knots) < 2:
            return Reason.KNOT_COUNT
        if not _at_rest(self._knots[-1]):
            return Reason.NOT_AT_REST
        self.ended = True
        return None

    def start(self) -> None:
        """Set off at full speed; the first knot is at rest, so nothing jumps."""
        self.rate = 1.0

    def stop(self) -> None:
        """Slow down along the path from now on."""
        self.stopping = True

    def step(self, dt_s: float) -> None:
        """Advance by `dt_s`; sets `command` and `command_velocity`."""
        if self.rate == 0.0:
            return
        rate = self.rate
        if self.stopping:
            rate = max(self.rate + self._braking() * dt_s, 0.0)
        self._path_us += (self.rate + rate) / 2 * dt_s * 1e6
        self.rate = rate
        position, velocity, _ = self._sample()
        self.command, self.command_velocity = position, velocity * rate
        first, second = self._knots[0], self._knots[1]
        share = min((self._path_us - first.t_us) / (second.t_us - first.t_us), 1.0)
        start, end = _preload(first), _preload(second)
        self.preload = start + (end - start) * share
        if self.arrived:
            self.rate = 0.0

    def _braking(self) -> float:
        """Fastest change of rate that keeps |q'' rate^2 + q' rate'| within the limits [1/s]."""
        _, velocity, acceleration = self._sample()
        spare = self._limits.acceleration_rad_s2 + np.sign(velocity) * acceleration * self.rate**2
        moving = np.abs(velocity) > 1e-9
        strongest = (spare[moving] / np.abs(velocity[moving])).min(initial=_FASTEST_BRAKING)
        return -max(float(strongest), 0.0)

    def _sample(self) -> tuple[Array, Array, Array]:
        """Path position and its first two derivatives by path time, (n,) each."""
        while len(self._knots) > 2 and self._knots[1].t_us <= self._path_us:
            self._knots.popleft()
            self._segment = None
        first, second = self._knots[0], self._knots[1]
        segment = self._segment
        if segment is None:
            segment = self._segment = segment_coefficients(from_wire((first, second)))
        h_us = second.t_us - first.t_us
        s = (self._path_us - first.t_us) / h_us
        inside = min(s, 1.0)
        h = np.array([h_us / 1e6])
        motion = evaluate_polynomial(segment, np.array([inside]), h)
        position, velocity = motion.position[0], motion.velocity[0]
        if s <= 1.0:
            return position, velocity, motion.acceleration[0]
        if self.ended:
            return position, np.zeros_like(velocity), np.zeros_like(velocity)
        # The path is used up while braking: go on straight until the joints stand.
        return position + velocity * (s - 1) * h[0], velocity, np.zeros_like(velocity)

    def _refusal(self, knot: Knot, present: Array) -> tuple[Reason, int] | None:
        if len(knot.position_urad) != len(present):
            return Reason.MALFORMED, 0
        if self.ended:
            return Reason.KNOT_COUNT, 0
        if self.free == 0:
            return Reason.BUFFER_FULL, 0
        return self._first_refusal(knot, present) if not self._knots else self._next_refusal(knot)

    def _first_refusal(self, knot: Knot, present: Array) -> tuple[Reason, int] | None:
        if knot.t_us != 0:
            return Reason.TIME_NOT_INCREASING, 0
        if not _at_rest(knot):
            return Reason.NOT_AT_REST, 0
        distance = self.error(present, np.array(knot.position_urad) / 1e6)
        if distance.max() > START_DISTANCE_RAD:
            return Reason.TOO_FAR_FROM_START, int(distance.argmax())
        return _preload_refusal(knot, self.preload, _PRELOAD_STEP_RAD)

    def _next_refusal(self, knot: Knot) -> tuple[Reason, int] | None:
        if knot.t_us <= self._knots[-1].t_us:
            return Reason.TIME_NOT_INCREASING, 0
        if knot.t_us <= self._path_us:
            return Reason.LATE, 0
        if not SEGMENT_US[0] <= knot.t_us - self._knots[-1].t_us <= SEGMENT_US[1]:
            return Reason.SEGMENT_TIME, 0
        segment = from_wire((self._knots[-1], knot))
        violation = first_violation(segment, self._limits)
        if violation is None and self._motors is not None:
            violation = first_motor_violation(segment, *self._motors)
        if violation is not None:
            return violation.reason, violation.joint
        seconds = (knot.t_us - self._knots[-1].t_us) / 1e6
        change = PRELOAD_SPEED_RAD_S * seconds + PRELOAD_URAD / COUNTS_PER_UNIT
        return _preload_refusal(knot, _preload(self._knots[-1]), change)


def _preload(knot: Knot) -> Array:
    return np.array(knot.preload_20urad) * (PRELOAD_URAD / COUNTS_PER_UNIT)


def _preload_refusal(knot: Knot, before: Array, change_rad: float) -> tuple[Reason, int] | None:
    """Whether the preload keeps to its bound and comes no faster than `change_rad` from `before`."""
    preload = _preload(knot)
    faults = (np.abs(preload) > PRELOAD_LIMIT_RAD) | (np.abs(preload - before) > change_rad)
    return (Reason.PRELOAD_LIMIT, int(np.flatnonzero(faults)[0])) if faults.any() else None


def _at_rest(knot: Knot) -> bool:
    return not any(knot.velocity_urad_s) and not any(knot.acceleration_urad_s2)
