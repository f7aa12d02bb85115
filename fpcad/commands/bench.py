"""What the verbs for single motors do with a hand that is built: the bench in front of a person."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
import typer
from rich.console import Console

from fpcad.commands.drive import kept_calibration, kept_map, kept_zeros, needed_port, pace_of
from fpcad.commands.live import live_joints
from fpcad.commands.numbering import known_name, servos_of
from fpcad.run.bus import ServoBus
from fpcad.run.calibration import Calibration, transmission_hash, write_calibration
from fpcad.run.controller_homing import home_controller
from fpcad.run.driver import Driver
from fpcad.run.drivers.choose import (
    guards_of,
    simulated_bus,
    simulated_map,
)
from fpcad.run.drivers.fw import ControllerBus
from fpcad.run.drivers.sim import SimBus
from fpcad.run.errors import HomingError, LimitsError
from fpcad.run.firmware import FirmwareDriver
from fpcad.run.hand_files import HandFiles
from fpcad.run.homing import Homed, Homing, Report
from fpcad.run.interrupt import counted_interrupts
from fpcad.run.knots import approach
from fpcad.run.limits import from_counts
from fpcad.run.messages import HomingReport, Telemetry
from fpcad.run.motor_map import Array, MotorMap
from fpcad.run.plan import APPROACH_SHARE
from fpcad.run.pull_test import PullTest
from fpcad.run.quintic import Knots
from fpcad.run.run_trajectory import controller_line, follow
from fpcad.run.servo_driver import ServoDriver
from fpcad.run.session import handshake
from fpcad.run.stream import to_sample

out = Console()
_TIGHT_RAD = math.radians(2.0)
"""Slack of a spool that is good enough."""


class Bench:
    """A hand, the driver that reaches it, and the file of what was measured on it."""

    def __init__(self, hand: HandFiles, driver: str, port: str | None, calibration: Path) -> None:
        self.hand, self.driver, self.port, self.calibration = hand, driver, port, calibration
        self._pace = pace_of(driver, port)

    def home(self) -> Calibration:
        """Find zeros and write them down."""
        found = self._home_controller() if self.driver == "fw" else self._home_servos()
        self._keep(found)
        return found

    def calibrate(self, yes: bool) -> None:
        """Home, verify signs with the person's eyes, measure stiffness."""
        if self.driver == "fw":
            self.home()
            out.print(
                "stiffness is measured on servo buses only; the firmware keeps its motors to itself"
            )
            return
        found = self._home_servos()
        with self._servos() as bus, counted_interrupts():
            motors = self.hand.motor_map(found).settled(
                bus.read_state().position_rad, self.hand.limits
            )
            bus.torque(True)
            self._verify_signs(bus, motors, yes)
            soft = self._pulls(bus, motors).stiffness()
        kept = replace(found, stiffness_nm_rad=soft)
        self._keep(kept)
        for name, value in zip(kept.motors, kept.stiffness_nm_rad, strict=True):
            out.print(f"{name}: {value:.1f} N m/rad")

    def tension(self, motor: str | None, yes: bool) -> None:
        """Tell the slack of one motor's tendons, or of all."""
        names = self.hand.motors if motor is None else (known_name(motor, self.hand.motors),)
        with self._servos() as bus:
            motors = self._map().settled(bus.read_state().position_rad, self.hand.limits)
            bus.torque(True)
            if isinstance(bus, SimBus):
                bus.hand.lock(True)  # nobody can hold a simulated finger
            for name in names:
                if not yes:
                    typer.prompt(f"Hold the finger of {name} still, then hit Enter", default="")
                found = self._pulls(bus, motors).slack(self.hand.motors.index(name))
                verdict = "good" if found.slack_rad <= _TIGHT_RAD else "tighten its loop"
                out.print(
                    f"{name}: slack {math.degrees(found.slack_rad):.1f} deg, "
                    f"{found.stiffness_nm_rad:.1f} N m/rad: {verdict}"
                )

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

    def _home_servos(self) -> Calibration:
        pace, limits, known = self._pace, self.hand.limits, self.hand.motor_map()
        with (
            self._servos() as bus,
            counted_interrupts() as stops,
            live_joints("home", ()) as show,
        ):

            def report(at: Report) -> None:
                show(at.done * 100, 100, f"{at.joint} {at.step}", None)

            search = Homing(bus, known, limits, pace.clock, pace.sleep, report, stops)
            return self._measured(search.run())

    def _home_controller(self) -> Calibration:
        limits = self.hand.limits
        with self._connect() as line, counted_interrupts() as stops:
            link, _ = handshake(line, limits)
            with live_joints("home", limits.names) as show:

                def note(msg: Telemetry, report: HomingReport | None) -> None:
                    done = 0 if report is None else min(report.joint, len(limits.names))
                    where = "" if report is None else limits.names[min(done, len(limits.names) - 1)]
                    show(done, len(limits.names), where, to_sample(msg, link.record.resends, 0))

                found = home_controller(link, limits, note, stops)
        count = len(self.hand.motors)
        return Calibration(
            "fw",
            transmission_hash(limits.configuration),
            self.hand.motors,
            limits.names,
            from_counts(found.offset_urad),
            np.ones(count),
            np.full(count, np.nan),
            from_counts(found.lower_urad),
            from_counts(found.upper_urad),
        )

    def _measured(self, found: Homed) -> Calibration:
        before = kept_calibration(self.hand, self.calibration, self.driver)
        nothing = np.full(len(self.hand.motors), np.nan)
        return Calibration(
            self.driver,
            transmission_hash(self.hand.limits.configuration),
            self.hand.motors,
            self.hand.limits.names,
            found.motors.mounting.zero_rad,
            found.motors.mounting.sign,
            nothing if before is None else before.stiffness_nm_rad,
            found.lower_rad,
            found.upper_rad,
        )

    def _keep(self, found: Calibration) -> None:
        write_calibration(self.calibration, found, self.hand.limits)
        out.print(f"zeros of {len(found.motors)} motors written to {self.calibration}")

    def _verify_signs(self, bus: ServoBus, motors: MotorMap, yes: bool) -> None:
        """Ranges tell motors of one finger apart; that a whole finger bends the right way, eyes do."""
        names = self.hand.limits.names
        size = self.hand.transmission.group
        test = self._pulls(bus, motors)
        for first in range(0, len(names), size):
            if yes:
                continue
            test.nod(first)
            if not typer.confirm(f"{names[first]}: did the finger just bend towards the palm?"):
                raise HomingError(
                    f"{names[first]}: turns the other way; turn the signs of its motors round under "
                    "motors: wiring: signs: in the design, and calibrate again"
                ).leaving("It holds where it is.")

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

    def _pulls(self, bus: ServoBus, motors: MotorMap) -> PullTest:
        return PullTest(bus, motors, self.hand.limits, self._pace.clock, self._pace.sleep)

    def _connect(self):
        return controller_line(needed_port("fw", self.port), self.hand.limits, self._straight())

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
