"""Stiffness and slack of tendons behind the project's firmware, which keeps its motors to itself.

A goal beyond what blocks a joint is a preload. The motors then stand where their pull and the tendons' balance,
and telemetry tells both: positions come from the motors' encoders, and each motor's current is its torque.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.run.driver import Driver, Sample, Watch
from fpcad.run.drivers.servo_types import ServoModel
from fpcad.run.limits import PRELOAD_LIMIT_RAD, JointLimits
from fpcad.run.plan import from_present, resting_within
from fpcad.run.pull_test import NOD_RAD, Slack, leading
from fpcad.run.quintic import Knots
from fpcad.run.transmission import Transmission

Array = NDArray[np.float64]

_STEP_RAD = 0.02
"""By how much the goal goes further at a time."""
_STEP_S = 0.1
_SETTLE_S = 0.4
"""Until motors rest, and their currents have been told: ten times a second."""
_LEAST_SHARE, _ENOUGH_SHARE = 0.03, 0.2
"""Parts of the stall torque from which on a tendon counts as taut, and at which a pull ends."""


@dataclass(frozen=True)
class _Taut:
    """A straight line through what one motor told: torque = stiffness * (spool - zero)."""

    stiffness_nm_rad: float
    zero_rad: float


class PreloadPull:
    """Pulls with motors `names` of a controller that is READY and homed, its preload zero."""

    def __init__(
        self,
        driver: Driver,
        names: tuple[str, ...],
        limits: JointLimits,
        gears: Transmission,
        servo: ServoModel,
        stops: Callable[[], int] = lambda: 0,
    ) -> None:
        self._driver, self._names, self._limits, self._gears = driver, names, limits, gears
        self._stall_nm = servo.stall_nm
        self._nm_per_ma = servo.stall_nm / servo.stall_ma
        self._watch = Watch(self._note, stops)
        self._now = driver.ready(clear=False)
        self._place = resting_within(self._now, limits)
        self._preload = np.zeros(len(names))

    def stiffness(self) -> Array:
        """Stiffness of each motor's tendons (n,) [N m/rad], nan where a motor met no resistance.

        Each joint is pressed on its upper end stop, so that the stop's own softness is part of it.
        """
        found = np.full(len(self._names), np.nan)
        for joint in range(len(self._names)):
            mine = [m for m in leading(self._gears.matrix, joint) if np.isnan(found[m])]
            if not mine:
                continue
            home = self._place
            self._go(_with(home, joint, self._limits.upper_rad[joint]))
            taut = self._pull(_with(np.zeros(len(home)), joint, 1.0), mine)
            self._go(home)
            for m in mine:
                found[m] = abs(taut[m].stiffness_nm_rad)
        return found

    def slack(self, motor: int) -> Slack:
        """Slack and stiffness of one motor's loop while somebody holds its finger still; nan without."""
        alone = np.linalg.solve(self._gears.matrix, np.eye(len(self._names))[motor])
        ends = [self._pull(way * alone, [motor])[motor] for way in (1.0, -1.0)]
        stiffness = np.mean([abs(end.stiffness_nm_rad) for end in ends])
        slack = max(ends[0].zero_rad - ends[1].zero_rad, 0.0)
        nothing = np.isnan(stiffness)
        return Slack(self._names[motor], np.nan if nothing else float(slack), float(stiffness))

    def nod(self, joint: int) -> None:
        """Turn one joint a little way up and back, for eyes that watch."""
        home = self._place
        bent = min(home[joint] + NOD_RAD, self._limits.upper_rad[joint])
        self._go(_with(home, joint, bent))
        self._go(home)

    def _pull(self, direction: Array, motors: list[int]) -> dict[int, _Taut]:
        """Put goals further and further along a joint direction (n,) until all motors pull enough."""
        farthest = PRELOAD_LIMIT_RAD / float(np.abs(direction).max())
        steps = int(farthest / _STEP_RAD)
        told: list[Array] = []  # (2, n) each: spools [rad], torques [N m]
        for step in range(1, steps + 1):
            self._load(step * _STEP_RAD * direction)
            told.append(self._settled())
            if (told[-1][1][motors] > _ENOUGH_SHARE * self._stall_nm).all():
                break
        self._load(np.zeros(len(direction)))
        spool, torque = np.stack(told, axis=1)
        return {m: self._fit(spool[:, m], torque[:, m]) for m in motors}

    def _fit(self, spool: Array, torque: Array) -> _Taut:
        taut = torque > _LEAST_SHARE * self._stall_nm
        if taut.sum() < 2 or np.ptp(spool[taut]) == 0:
            return _Taut(np.nan, np.nan)
        slope, offset = np.polyfit(spool[taut], torque[taut], 1)
        return _Taut(float(slope), float(-offset / slope))

    def _load(self, preload: Array) -> None:
        """Stand still while the preload goes to (n,) [rad]."""
        change = float(np.abs(preload - self._preload).max())
        seconds = max(change / (_STEP_RAD / _STEP_S), _STEP_S)
        still = np.zeros((2, len(preload)))
        standing = np.stack([self._place, self._place])
        both = np.stack([self._preload, preload])
        self._driver.play(
            Knots(np.array([0.0, seconds]), standing, still, still, both), self._watch
        )
        self._preload = preload

    def _settled(self) -> Array:
        """Where the spools rest and with which torque their motors pull (2, n) [rad, N m]."""
        began_s = self._now.device_s
        self._driver.wait(lambda: self._now.device_s - began_s >= _SETTLE_S, self._watch)
        current = self._now.current_ma
        torque = np.zeros(len(self._names)) if current is None else np.abs(current)
        spool = self._gears.matrix @ self._now.position_rad + self._gears.offset_rad
        return np.stack([spool, torque * self._nm_per_ma])

    def _go(self, place: Array) -> None:
        still = np.zeros((1, len(place)))
        there = Knots(np.zeros(1), place[None], still, still)
        way = from_present(self._now, there, self._limits, far=True)
        if len(way.time_s) > 1:
            self._driver.play(way, self._watch)
        self._place = place

    def _note(self, sample: Sample) -> None:
        self._now = sample


def _with(values: Array, place: int, value: float) -> Array:
    changed = values.copy()
    changed[place] = value
    return changed
