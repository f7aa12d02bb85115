"""How soft a tendon pulls and how much slack it has, told by its motor alone while its joint is blocked."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.run.bus import ServoBus
from fpcad.run.limits import JointLimits
from fpcad.run.link import Clock
from fpcad.run.motor_map import MotorMap

Array = NDArray[np.float64]

SHARES = (0.1, 0.3)
"""Parts of a motor's torque that it pulls with, one after the other."""
_BEYOND_RAD = 1.0
"""How far a goal lies beyond what blocks: more than the motor can stretch its tendon."""
_APPROACH_RAD_S = 1.0
NOD_RAD = 0.5
_SETTLE_S = 0.4
_PERIOD_S = 0.01
_SAMPLES = 10
_LEAST_MOVE_RAD = 2 * np.pi / 4096


@dataclass(frozen=True)
class Pull:
    """A motor that has come to rest against its tendon."""

    spool_rad: Array  # (n,)
    torque_nm: Array  # (n,) at the spools, without sign


def leading(matrix: Array, joint: int) -> list[int]:
    """Motors (rows of an (n, n) transmission) that pull a joint at least as strongly as any other."""
    rows = np.abs(matrix)
    return [int(m) for m in np.flatnonzero(rows[:, joint] >= rows.max(axis=1) - 1e-9)]


@dataclass(frozen=True)
class Slack:
    """One motor's tendon, its joint held."""

    motor: str
    slack_rad: float
    """Turn of the spool in which the tendon does not pull."""
    stiffness_nm_rad: float


class PullTest:
    """Pulls on a bus that is open and homed, torque on."""

    def __init__(
        self,
        bus: ServoBus,
        motors: MotorMap,
        limits: JointLimits,
        clock: Clock = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self._bus, self._map, self._limits = bus, motors, limits
        self._clock, self._sleep = clock, sleep

    def stiffness(self) -> Array:
        """Stiffness of each motor's tendons (n,) [N m/rad], nan where a motor did not move.

        Each joint is pressed on its upper end stop with two torques; the motors that turn with it
        tell how much further they got.
        """
        found = np.full(len(self._bus.names), np.nan)
        for joint in range(len(self._map.joints)):
            mine = [m for m in leading(self._map.transmission.matrix, joint) if np.isnan(found[m])]
            if not mine:
                continue
            weak, strong = self._push(joint)
            turned = np.abs(strong.spool_rad - weak.spool_rad)
            torque = strong.torque_nm - weak.torque_nm
            for m in mine:
                if turned[m] > _LEAST_MOVE_RAD and torque[m] > 0:
                    found[m] = torque[m] / turned[m]
        return found

    def slack(self, motor: int) -> Slack:
        """Slack and stiffness of one motor's loop while somebody holds its joint still."""
        name = self._bus.names[motor]
        start = self._bus.read_state().position_rad
        travel, torque = [], []
        for share in SHARES:
            self._bus.limit_torque(share)
            ends = [self._pull(start, motor, way) for way in (1.0, -1.0)]
            travel.append(abs(ends[0].spool_rad[motor] - ends[1].spool_rad[motor]))
            torque.append((ends[0].torque_nm[motor] + ends[1].torque_nm[motor]) / 2)
        self._go(start)
        self._bus.limit_torque(1.0)
        stretch = max(travel[1] - travel[0], _LEAST_MOVE_RAD)
        stiffness = 2 * (torque[1] - torque[0]) / stretch
        slack = travel[0] - 2 * torque[0] / stiffness if stiffness > 0 else travel[0]
        return Slack(name, max(float(slack), 0.0), float(stiffness))

    def nod(self, joint: int) -> None:
        """Turn one joint a little way up and back, for eyes that watch."""
        rest = self._map.to_joints(self._bus.read_state().position_rad)
        bent = rest.copy()
        bent[joint] = min(rest[joint] + NOD_RAD, self._limits.upper_rad[joint])
        for goal in (bent, rest):
            self._go(self._map.to_bus(goal))

    def _push(self, joint: int) -> tuple[Pull, Pull]:
        """Push a joint on its upper end with both torques, then bring it back."""
        rest = self._map.to_joints(self._bus.read_state().position_rad)
        goal = rest.copy()
        self._bus.limit_torque(SHARES[0])
        goal[joint] = self._limits.upper_rad[joint] + _BEYOND_RAD
        self._go(self._map.to_bus(goal))
        pulls = []
        for share in SHARES:
            self._bus.limit_torque(share)
            self._bus.write_goals(self._map.to_bus(goal))
            pulls.append(self._settled(self._map.to_bus(goal)))
        self._bus.limit_torque(SHARES[0])
        self._go(self._map.to_bus(rest))
        self._bus.limit_torque(1.0)
        return pulls[0], pulls[1]

    def _pull(self, start: Array, motor: int, way: float) -> Pull:
        goal = start.copy()
        goal[motor] += way * _BEYOND_RAD * self._map.mounting.ratio[motor]
        self._go(goal)
        return self._settled(goal)

    def _go(self, goal: Array) -> None:
        """Lead all motors to bus angles (n,), slowly, from where they are."""
        start = self._bus.read_state().position_rad
        steps = max(int(np.abs(goal - start).max() / (_APPROACH_RAD_S * _PERIOD_S)), 1)
        for share in np.linspace(0.0, 1.0, steps + 1)[1:]:
            self._bus.write_goals(start + share * (goal - start))
            self._sleep(_PERIOD_S)
            self._bus.read_state()

    def _settled(self, goal: Array) -> Pull:
        until = self._clock() + _SETTLE_S
        while self._clock() < until:
            self._bus.write_goals(goal)  # feeds the watchdog
            self._sleep(_PERIOD_S)
        states = [self._bus.read_state() for _ in range(_SAMPLES)]
        position = np.mean([state.position_rad for state in states], axis=0)
        current = np.mean([state.current_ma for state in states], axis=0)
        torque = current * self._bus.torque_per_ma * self._map.mounting.ratio
        return Pull(self._map.mounting.to_spool(position), torque)
