"""What the verbs for single motors do with a hand that is built: the bench in front of a person."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from pathlib import Path

import numpy as np
from rich.console import Console

from fpcad.commands.drive import kept_map, kept_zeros, needed_port, pace_of
from fpcad.commands.live import live_joints
from fpcad.commands.numbering import known_name, servos_of
from fpcad.run.bus import ServoBus
from fpcad.run.driver import Driver
from fpcad.run.drivers.choose import (
    guards_of,
    simulated_bus,
    simulated_map,
)
from fpcad.run.drivers.fw import ControllerBus
from fpcad.run.errors import LimitsError
from fpcad.run.firmware import FirmwareDriver
from fpcad.run.hand_files import HandFiles
from fpcad.run.knots import approach
from fpcad.run.motor_map import Array, MotorMap
from fpcad.run.plan import APPROACH_SHARE
from fpcad.run.quintic import Knots
from fpcad.run.run_trajectory import controller_line, follow
from fpcad.run.servo_driver import ServoDriver
from fpcad.run.sim.spawn import Mishap

out = Console()


class Bench:
    """A hand, the driver that reaches it, and the file of what was measured on it."""

    def __init__(self, hand: HandFiles, driver: str, port: str | None, calibration: Path) -> None:
        self.hand, self.driver, self.port, self.calibration = hand, driver, port, calibration
        self._pace = pace_of(driver, port)

    def jog(self, joint: str, to_deg: float | None, by_deg: float | None, clear: bool) -> None:
        """Move one joint slowly."""
        number = self.hand.limits.names.index(known_name(joint, self.hand.limits.names))
        with self._driver() as driver:
            present = driver.ready(clear=clear)
            goal = present.command_rad.copy()
            goal[number] = math.radians(
                math.degrees(goal[number]) + by_deg if by_deg is not None else to_deg or 0.0
            )
            self._require_within(number, goal[number])
            still = np.zeros((1, len(goal)))
            there = Knots(np.zeros(1), goal[None], still, still)
            move = approach(present.command_rad, there, self.hand.limits, APPROACH_SHARE)
            if len(move.time_s) > 1:
                with live_joints(joint, self.hand.limits.names) as show:
                    follow(
                        driver,
                        [move],
                        self.hand.limits.names,
                        on_progress=lambda at: show(at.path_s, at.total_s, at.state, at.sample),
                    )
            reached = math.degrees(goal[number])
        out.print(f"{joint}: led to {reached:.1f} deg")

    def hold(self, let_go: bool) -> None:
        """Motors on where the hand is, or off."""
        if self.driver == "fw":
            bus = ControllerBus(self.hand.limits, self._connect)
        else:
            bus = self._made_bus()
        with closing(bus):
            bus.open()
            bus.torque(not let_go)
            if let_go:
                out.print("torque is off, the hand lets go")
                return
            out.print(f"the hand holds where it is. {bus.without_host}")

    @contextmanager
    def _servos(self) -> Iterator[ServoBus]:
        bus = self._made_bus()
        with closing(bus):
            bus.open()
            yield bus

    def _made_bus(self) -> ServoBus:
        if self.driver == "sim":
            return simulated_bus(self.hand, self._straight(), self._pace)
        return servos_of(self.hand, self.driver, self.port)

    def _map(self) -> MotorMap:
        if self.driver == "sim":
            return simulated_map(self.hand)
        return kept_map(self.hand, self.calibration, self.driver)

    @contextmanager
    def _driver(self) -> Iterator[Driver]:
        if self.driver == "fw":
            zeros = kept_zeros(self.hand, self.calibration, needed_port("fw", self.port))
            with self._connect() as line:
                yield FirmwareDriver(line, self.hand.limits, zeros_rad=zeros)
            return
        motors = self._map()
        with self._servos() as bus:
            guards = guards_of(self.hand, bus)
            pace = self._pace
            yield ServoDriver(bus, motors, self.hand.limits, guards, pace.clock, pace.sleep)

    def _connect(self, mishaps: Sequence[Mishap] = ()):
        port = needed_port("fw", self.port)
        return controller_line(port, self.hand.limits, self._straight(), mishaps)

    def _straight(self) -> Array:
        limits = self.hand.limits
        return np.minimum(np.maximum(0.0, limits.lower_rad), limits.upper_rad)

    def _require_within(self, joint: int, goal_rad: float) -> None:
        limits = self.hand.limits
        low, high = limits.lower_rad[joint], limits.upper_rad[joint]
        if not low <= goal_rad <= high:
            raise LimitsError(
                f"{limits.names[joint]}: {math.degrees(goal_rad):.1f} deg is beyond its limits, "
                f"{math.degrees(low):.0f} to {math.degrees(high):.0f}"
            )
