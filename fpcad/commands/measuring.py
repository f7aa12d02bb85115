"""Measuring a hand that is built: zeros, signs, stiffness and slack, by whatever drives its motors."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import typer

from fpcad.commands.bench import Bench, out
from fpcad.commands.drive import kept_calibration, kept_zeros, needed_port
from fpcad.commands.live import live_joints
from fpcad.commands.numbering import known_name
from fpcad.run.bus import ServoBus
from fpcad.run.calibration import Calibration, transmission_hash, write_calibration
from fpcad.run.controller_homing import home_controller
from fpcad.run.drivers.choose import (
    servo_of,
)
from fpcad.run.drivers.sim import SimBus
from fpcad.run.errors import HomingError
from fpcad.run.firmware import FirmwareDriver
from fpcad.run.homing import Homed, Homing, Report
from fpcad.run.interrupt import counted_interrupts
from fpcad.run.limits import from_counts
from fpcad.run.messages import HomingReport, Telemetry
from fpcad.run.motor_map import Array, MotorMap
from fpcad.run.port import Transport
from fpcad.run.preload_pull import PreloadPull
from fpcad.run.pull_test import PullTest, Slack
from fpcad.run.session import handshake
from fpcad.run.sim.spawn import Mishap
from fpcad.run.stream import to_sample

_TIGHT_RAD = math.radians(2.0)
"""Slack of a spool that is good enough."""
_SIGNS = ("under motors: wiring: signs: in the design", "in the mounts of the firmware's servo bus")


class Measuring(Bench):
    """A bench at which a hand is measured; what is found goes to the file of its calibration."""

    def home(self) -> Calibration:
        """Find zeros and write them down."""
        if self.driver == "fw":
            with self._connect() as line:
                found = self._home_controller(line)
        else:
            found = self._home_servos()
        self._keep(found)
        return found

    def calibrate(self, yes: bool) -> None:
        """Home, verify signs with the person's eyes, measure stiffness."""
        kept = (
            self._calibrate_controller(yes) if self.driver == "fw" else self._calibrate_servos(yes)
        )
        self._keep(kept)
        for name, value in zip(kept.motors, kept.stiffness_nm_rad, strict=True):
            soft = "met no resistance" if np.isnan(value) else f"{value:.1f} N m/rad"
            out.print(f"{name}: {soft}")

    def tension(self, motor: str | None, yes: bool) -> None:
        """Tell the slack of one motor's tendons, or of all."""
        names = self.hand.motors if motor is None else (known_name(motor, self.hand.motors),)
        with self._slack_test() as slack:
            for name in names:
                if not yes:
                    typer.prompt(f"Hold the finger of {name} still, then hit Enter", default="")
                _tell(slack(self.hand.motors.index(name)))

    @contextmanager
    def _slack_test(self) -> Iterator[Callable[[int], Slack]]:
        """What tells a motor's slack; simulated fingers are held, for nobody else can."""
        if self.driver == "fw":
            joints = range(len(self.hand.limits.names))
            simulated = needed_port("fw", self.port).partition(":")[0] == "fw"
            held = [Mishap("grasp", 0.0, joint) for joint in joints] if simulated else []
            zeros = kept_zeros(self.hand, self.calibration, needed_port("fw", self.port))
            with self._connect(held) as line, counted_interrupts() as stops:
                yield self._preload_pull(line, zeros, stops).slack
            return
        with self._servos() as bus:
            motors = self._map().settled(bus.read_state().position_rad, self.hand.limits)
            bus.torque(True)
            if isinstance(bus, SimBus):
                bus.hand.lock(True)
            yield self._pulls(bus, motors).slack

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

    def _calibrate_servos(self, yes: bool) -> Calibration:
        found = self._home_servos()
        with self._servos() as bus, counted_interrupts():
            motors = self.hand.motor_map(found).settled(
                bus.read_state().position_rad, self.hand.limits
            )
            bus.torque(True)
            test = self._pulls(bus, motors)
            self._verify_signs(test.nod, yes)
            return replace(found, stiffness_nm_rad=test.stiffness())

    def _calibrate_controller(self, yes: bool) -> Calibration:
        with self._connect() as line:
            found = self._home_controller(line)
            with counted_interrupts() as stops:
                test = self._preload_pull(line, found.zero_rad, stops)
                self._verify_signs(test.nod, yes)
                return replace(found, stiffness_nm_rad=test.stiffness())

    def _preload_pull(
        self, line: Transport, zeros: Array | None, stops: Callable[[], int]
    ) -> PreloadPull:
        hand = self.hand
        driver = FirmwareDriver(line, hand.limits, zeros_rad=zeros)
        servo = servo_of(hand)
        return PreloadPull(driver, hand.motors, hand.limits, hand.transmission, servo, stops)

    def _home_controller(self, line: Transport) -> Calibration:
        limits = self.hand.limits
        with counted_interrupts() as stops:
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

    def _verify_signs(self, nod: Callable[[int], None], yes: bool) -> None:
        """Ranges tell motors of one finger apart; that a whole finger bends the right way, eyes do."""
        names = self.hand.limits.names
        size = self.hand.transmission.group
        for first in range(0, len(names), size):
            if yes:
                continue
            nod(first)
            if not typer.confirm(f"{names[first]}: did the finger just bend towards the palm?"):
                raise HomingError(
                    f"{names[first]}: turns the other way; turn the signs of its motors round "
                    f"{_SIGNS[self.driver == 'fw']}, and calibrate again"
                ).leaving("It holds where it is.")

    def _pulls(self, bus: ServoBus, motors: MotorMap) -> PullTest:
        return PullTest(bus, motors, self.hand.limits, self._pace.clock, self._pace.sleep)


def _tell(found: Slack) -> None:
    if np.isnan(found.slack_rad):
        out.print(
            f"{found.motor}: met no resistance; hold its finger, or see whether its tendon is off"
        )
        return
    verdict = "good" if found.slack_rad <= _TIGHT_RAD else "tighten its loop"
    out.print(
        f"{found.motor}: slack {math.degrees(found.slack_rad):.1f} deg, "
        f"{found.stiffness_nm_rad:.1f} N m/rad: {verdict}"
    )
