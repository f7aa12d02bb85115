"""Finds where a hand's joints end, over any servo bus: little torque, both ends, finger by finger.

The same procedure as the firmware's: a joint is led along the motors that move it alone (flexion: m1 + m2,
with m3 making up for the tendon that crosses the joint; abduction: m1 - m2), with little current, until it
stalls, at both ends. The middle between the ends is the middle of the design's range, so that the
stretch of tendons, the same on both sides, drops out.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fpcad.run.bus import BusState, ServoBus
from fpcad.run.calibration import designed_ranges, require_range
from fpcad.run.errors import HeldByUser, HomingError
from fpcad.run.limits import JointLimits
from fpcad.run.link import Clock
from fpcad.run.motor_map import MotorMap
from fpcad.run.servo_driver import ENCODER_END

Array = NDArray[np.float64]

HOMING_SHARE = 0.1
"""Part of a motor's torque that presses on an end stop."""
_SPEED_RAD_S = 0.6
_PERIOD_S = 0.01
_WATCHDOG_S = 0.5
_STALL_LAG_RAD = 0.08
"""Lag of the joint behind its goal, as its motors tell, that counts as an end."""
_STALL_CYCLES = 15
_TOO_FAR = 2.0
"""Multiple of the design's range after which there is no end."""


@dataclass(frozen=True)
class Homed:
    """Ends of n joints [rad] in the angles of the map that was found."""

    motors: MotorMap
    lower_rad: Array  # (n,)
    upper_rad: Array  # (n,)


@dataclass(frozen=True)
class Report:
    """What to show while it goes on."""

    joint: str
    step: str
    done: float
    """Part of all joints, 0 to 1."""


class Homing:
    """One search on a bus that is open. Joints go back to the middle of their range, or to 0."""

    def __init__(
        self,
        bus: ServoBus,
        motors: MotorMap,
        limits: JointLimits,
        clock: Clock = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
        on_report: Callable[[Report], None] = lambda _: None,
        stops: Callable[[], int] = lambda: 0,
    ) -> None:
        self._bus, self._limits = bus, limits
        self._clock, self._sleep, self._on_report, self._stops = clock, sleep, on_report, stops
        # Until ends are found, all that is known of a motor is by how much it turns.
        start = bus.read_state().position_rad
        self._map = replace(motors, mounting=replace(motors.mounting, zero_rad=start))
        self._goal = np.zeros(len(motors.joints))  # (n,) joint angles in that map

    def run(self) -> Homed:
        """Search all joints; torque stays on at the end, with all that the motors can."""
        self._bus.torque(True)
        self._bus.limit_torque(HOMING_SHARE)
        self._bus.watchdog(_WATCHDOG_S)
        try:
            ends = np.array([self._both_ends(j) for j in range(len(self._goal))])
        except BaseException:
            self._bus.write_goals(self._bus.read_state().position_rad)
            raise
        finally:
            self._bus.limit_torque(1.0)
        middle = ends.mean(axis=1)
        design = (self._limits.lower_rad + self._limits.upper_rad) / 2
        shift = middle - design  # what the provisional map calls too much
        zero = self._map.to_bus(shift)  # its spools' offset stays in the transmission
        found = replace(
            self._map, mounting=replace(self._map.mounting, zero_rad=zero - self._offset)
        )
        return Homed(found, ends[:, 0] - shift, ends[:, 1] - shift)

    @property
    def _offset(self) -> Array:
        mounting = self._map.mounting
        return mounting.sign * mounting.ratio * self._map.transmission.offset_rad

    def _both_ends(self, joint: int) -> tuple[float, float]:
        name = self._limits.names[joint]
        self._tell(joint, "to its lower end")
        lower = self._end(joint, -1.0)
        self._tell(joint, "to its upper end")
        upper = self._end(joint, 1.0)
        wanted = designed_ranges(self._limits)[joint]
        require_range(name, upper - lower, wanted, self._failure)
        # Rest where the finger hinders the others least: straight, or the middle of its range.
        straight = min(max(0.0, self._limits.lower_rad[joint]), self._limits.upper_rad[joint])
        design = (self._limits.lower_rad[joint] + self._limits.upper_rad[joint]) / 2
        self._tell(joint, "back")
        self._lead(joint, (lower + upper) / 2 + straight - design)
        return lower, upper

    def _end(self, joint: int, direction: float) -> float:
        """Lead a joint until it stalls; where that was, as its motors tell [rad]."""
        wanted = self._limits.upper_rad[joint] - self._limits.lower_rad[joint]
        travelled, stalled = 0.0, 0
        while travelled < _TOO_FAR * wanted:
            state = self._move(joint, direction * _SPEED_RAD_S * _PERIOD_S)
            travelled += _SPEED_RAD_S * _PERIOD_S
            at = self._map.to_joints(state.position_rad)[joint]
            stalled = stalled + 1 if direction * (self._goal[joint] - at) > _STALL_LAG_RAD else 0
            if stalled >= _STALL_CYCLES:
                self._goal[joint] = at
                self._move(joint, 0.0)
                return float(at)
        raise self._failure(
            f"{self._limits.names[joint]}: no end within {np.degrees(travelled):.0f} "
            "degrees; is its tendon torn, or its motor not pulling?"
        )

    def _lead(self, joint: int, goal: float) -> None:
        way = goal - self._goal[joint]
        steps = max(int(abs(way) / (_SPEED_RAD_S * _PERIOD_S)), 1)
        for _ in range(steps):
            self._move(joint, way / steps)

    def _move(self, joint: int, step_rad: float) -> BusState:
        """One cycle: the joint's goal a step further, all others where they are."""
        if self._stops() > 1:
            self._bus.torque(False)
            raise HeldByUser("homing stopped: torque is off, the hand lets go; zeros are unknown")
        if self._stops() > 0:
            raise HeldByUser("homing stopped: the hand holds where it is; zeros are unknown")
        self._goal[joint] += step_rad
        goal = self._map.to_bus(self._goal)
        least, greatest = self._bus.goal_range_rad
        for name, value in zip(self._bus.names, goal, strict=True):
            if not least <= value <= greatest:
                raise self._failure(f"{name}: {ENCODER_END}")
        self._bus.write_goals(goal)
        self._sleep(_PERIOD_S)
        return self._bus.read_state()

    def _failure(self, message: str) -> HomingError:
        return HomingError(message).leaving("It holds where it is, with little force.")

    def _tell(self, joint: int, step: str) -> None:
        self._on_report(Report(self._limits.names[joint], step, joint / len(self._goal)))
