"""Trajectories on a servo bus: the host evaluates the quintics itself, a hundred times a second.

What the firmware does beside its motors is done here for servos that have only their own brains: limits
from end to end before anything moves, slowing down along the path, and faults that stop the hand.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from fpcad.run.bus import BusState, ServoBus
from fpcad.run.driver import Played, Sample, Watch
from fpcad.run.errors import (
    CalibrationError,
    CommandRefused,
    HeldByUser,
    LinkLost,
    RunError,
    StoppedByUser,
)
from fpcad.run.knots import WireKnots, to_wire
from fpcad.run.limits import JointLimits
from fpcad.run.link import Clock
from fpcad.run.motor_limits import motor_limits_of
from fpcad.run.motor_map import MotorMap
from fpcad.run.quintic import Knots
from fpcad.run.servo_guard import ServoGuard, ServoGuards, cause_of
from fpcad.run.sim.follower import PathFollower

Array = NDArray[np.float64]

PERIOD_S = 0.01
_LONGEST_STEP_S = 0.03
"""A host that was stalled goes on from where it was: path time slips, goals never jump."""
WATCHDOG_S = 0.3
ENCODER_END = (
    "its range crosses the end of its encoder; take the spool off, turn the motor half a turn, put the "
    "spool on again, and calibrate"
)
_BRAKING_CYCLES = 100


class ServoDriver:
    """Joints behind a servo bus that is open; follows :class:`fpcad.run.driver.Driver`."""

    def __init__(
        self,
        bus: ServoBus,
        motors: MotorMap,
        limits: JointLimits,
        guards: ServoGuards,
        clock: Clock = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self._bus, self._map, self._limits = bus, motors, limits
        self._guard = ServoGuard(guards, bus.names)
        self._clock, self._sleep = clock, sleep
        first = bus.identify()[0]
        self.identity = f"{len(bus.names)} {first.model}, firmware {first.firmware}"
        self._began_s = clock()
        self.slipped_s = 0.0
        """Time that the path lost because the host came late."""

    def ready(self, *, clear: bool) -> Sample:
        """Torque on where the hand is; `clear` makes no difference, for nothing is latched here."""
        state = self._bus.read_state()
        self._map = self._map.settled(state.position_rad, self._limits)
        self._require_room()
        self._bus.torque(True)
        self._bus.limit_torque(1.0)  # homing may have left less
        self._bus.watchdog(WATCHDOG_S)
        return self._sample(self._bus.read_state(), None, "READY")

    def _require_room(self) -> None:
        """Each motor's whole range must lie where its encoder counts on without a jump."""
        least, greatest = self._bus.goal_range_rad
        low, high = self._map.bus_range(self._limits)
        for name, start, end in zip(self._bus.names, low, high, strict=True):
            if start < least or end > greatest:
                raise CalibrationError(f"{name}: {ENCODER_END}")

    def wait(self, until: Callable[[], bool], watch: Watch) -> None:
        """Hold still, watchdogs fed, while somebody puts the tool in."""
        goal = self._bus.read_state().position_rad
        cycle = _Cycle(self._clock, self._sleep)
        while not until():
            if watch.stops() > 0:
                raise HeldByUser("stopped while the hand was open: it stays where it is, motors on")
            cycle.wait()
            self._bus.write_goals(goal)
            watch.on_sample(self._sample(self._bus.read_state(), None, "READY"))

    def play(self, knots: Knots, watch: Watch) -> Played:
        wire = to_wire(knots)
        follower = self._loaded(wire)
        cycle = _Cycle(self._clock, self._sleep)
        sent = len(wire.messages)
        state = self._bus.read_state()
        try:
            while follower.rate > 0:
                if watch.stops() > 0:
                    follower.stop()
                if watch.stops() > 1:
                    self._let_go(follower, wire)
                state = self._step(follower, cycle)
                words = ("HOLD", "HOST") if follower.stopping else ("RUNNING", "NONE")
                watch.on_sample(self._sample(state, follower, *words, sent))
                self._guard.check(state, follower, self._map)
            if follower.stopping:
                self._held(follower, wire)
        except BaseException as error:
            if not isinstance(error, HeldByUser | StoppedByUser):
                self._brake(follower, cycle, error)
            if isinstance(error, RunError):  # the table's last row tells how it ended
                words = _state_after(error), cause_of(error)
                watch.on_sample(self._sample(state, follower, *words, sent))
            raise
        self.slipped_s = cycle.slipped_s
        state = self._bus.read_state()
        watch.on_sample(self._sample(state, follower, "READY", "NONE", sent))
        return Played(sent, 0, state.bad_frames, wire.error_rad, "READY")

    def _loaded(self, wire: WireKnots) -> PathFollower:
        """A follower with all knots, each checked as the firmware would."""
        present = self._map.to_joints(self._bus.read_state().position_rad)
        gears = self._map.transmission, motor_limits_of(self._limits)
        follower = PathFollower(self._limits, len(wire.messages), present, gears)
        for knot in wire.messages:
            refusal = follower.offer(knot, present)
            if refusal is not None:
                reason, joint = refusal
                raise CommandRefused(
                    f"{self._limits.names[joint]}: {reason.name.lower().replace('_', ' ')} "
                    f"at {knot.t_us / 1e6:.2f} s"
                ).leaving("It holds where it is.")
        follower.end(len(wire.messages))
        follower.start()
        return follower

    def _step(self, follower: PathFollower, cycle: _Cycle) -> BusState:
        follower.step(cycle.wait())
        self._bus.write_goals(self._map.to_bus(follower.command + follower.preload))
        return self._bus.read_state()

    def _brake(self, follower: PathFollower, cycle: _Cycle, error: BaseException) -> None:
        """Bring the joints that still listen to rest along the path, without asking anything."""
        follower.stop()
        with suppress(RunError):
            for _ in range(_BRAKING_CYCLES):
                if follower.rate == 0:
                    break
                follower.step(cycle.wait())
                self._bus.write_goals(self._map.to_bus(follower.command + follower.preload))
        if isinstance(error, RunError) and not isinstance(error, LinkLost):
            error.leaving("The other joints slowed down along the path and hold.")

    def _let_go(self, follower: PathFollower, wire: WireKnots) -> NoReturn:
        self._bus.torque(False)
        raise StoppedByUser(f"stopped {_place(follower, wire)}: torque is off, the hand lets go")

    def _held(self, follower: PathFollower, wire: WireKnots) -> NoReturn:
        raise HeldByUser(
            f"held {_place(follower, wire)}: the hand keeps its grip, motors stay on. "
            f"{self._bus.without_host}"
        )

    def _sample(
        self,
        state: BusState,
        follower: PathFollower | None,
        word: str,
        cause: str = "NONE",
        sent: int = 0,
    ) -> Sample:
        position = self._map.to_joints(state.position_rad)
        return Sample(
            self._clock() - self._began_s,
            0.0 if follower is None else follower.path_us / 1e6,
            word,
            cause,
            position,
            position if follower is None else follower.command,
            0 if follower is None else follower.queued,
            state.bad_frames,
            0,
            sent,
            state.current_ma,
            state.temperature_c,
            None if follower is None else follower.preload,
        )


class _Cycle:
    """The beat of the bus; how long each step of the path lasts."""

    def __init__(self, clock: Clock, sleep: Callable[[float], None]) -> None:
        self._clock, self._sleep = clock, sleep
        self._last_s = self._due_s = clock()
        self.slipped_s = 0.0

    def wait(self) -> float:
        """Wait for the next beat; the step [s] that the path takes, never a jump."""
        self._due_s += PERIOD_S
        ahead = self._due_s - self._clock()
        if ahead > 0:
            self._sleep(ahead)
        else:
            self._due_s -= ahead
        now = self._clock()
        passed, self._last_s = now - self._last_s, now
        step = min(passed, _LONGEST_STEP_S)
        self.slipped_s += passed - step
        return step


def _state_after(error: BaseException) -> str:
    """The state that a controller would be in."""
    if isinstance(error, StoppedByUser):
        return "ESTOP"
    return "HOLD" if isinstance(error, HeldByUser) else "FAULT"


def _place(follower: PathFollower, wire: WireKnots) -> str:
    return f"at {follower.path_us / 1e6:.2f} s of {wire.duration_us / 1e6:.2f} s"
