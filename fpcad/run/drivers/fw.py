"""The project's own firmware, or its simulator, as a bus: its axes are joints.

The controller makes paths of its own from goals that come now and then, so a goal becomes a slow
straight move. Whole trajectories go to it as knots instead (:mod:`fpcad.run.stream`).
"""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import AbstractContextManager, ExitStack

import numpy as np
from numpy.typing import NDArray

from fpcad.run.bus import BusState, Identity, checked_goals
from fpcad.run.driver import Sample, Watch
from fpcad.run.errors import (
    CommandRefused,
    ControllerFault,
    ControllerHeld,
    ControllerSilent,
    PortMissing,
    WatchdogTripped,
)
from fpcad.run.knots import approach, to_wire
from fpcad.run.limits import COUNTS_PER_UNIT, JointLimits
from fpcad.run.link import Clock, Link
from fpcad.run.messages import (
    Cause,
    Clear,
    Estop,
    Health,
    Refused,
    State,
    Telemetry,
    Welcome,
)
from fpcad.run.port import Transport
from fpcad.run.quintic import Knots
from fpcad.run.session import HANDSHAKE_S, handshake
from fpcad.run.stream import KnotStream, to_sample

Array = NDArray[np.float64]

Connect = Callable[[], AbstractContextManager[Transport]]
SILENCE_S = 0.5
"""After which the firmware stops by itself, whatever the host asks for."""
_ANSWER_S = 1.0
_REPEAT_S = 0.05
_SHARE = 0.2
"""Part of the limits that moves to goals may use."""
_LATCHED = (State.HOLD, State.FAULT, State.ESTOP)


class ControllerBus:
    """A session with a controller that fits `limits`; `connect` opens the line to it."""

    without_host = "Its controller slows it down half a second after the last word, and holds it."

    def __init__(
        self,
        limits: JointLimits,
        connect: Connect,
        clock: Clock = time.monotonic,
        patience_s: float = HANDSHAKE_S,
    ) -> None:
        self.names = limits.names
        self._limits, self._connect, self._clock = limits, connect, clock
        self._patience_s = patience_s
        self._line = ExitStack()
        self._link: Link | None = None
        self._welcome: Welcome | None = None
        self._stream: KnotStream | None = None
        self._telemetry: Telemetry | None = None
        self._health: Health | None = None
        self._goal: Array | None = None
        self._seen = 0

    def open(self) -> None:
        with ExitStack() as line:
            transport = line.enter_context(self._connect())
            link, self._welcome = handshake(transport, self._limits, self._clock, self._patience_s)
            self._line, self._link = line.pop_all(), link
        self._until(lambda: self._telemetry is not None, "sends no telemetry")

    def identify(self) -> tuple[Identity, ...]:
        self._need_link()
        assert self._welcome is not None
        build = self._welcome.build.rstrip(b"\0").decode("ascii", "replace")
        version = f"protocol {self._welcome.protocol}"
        return tuple(Identity(name, i, build, version) for i, name in enumerate(self.names))

    def read_state(self) -> BusState:
        self._until_next_telemetry()
        if self._state is State.FAULT:
            raise ControllerFault(
                f"the controller is in FAULT: {self._cause.name.lower()}; clear it"
            )
        now = self.sample()
        nothing = np.zeros(len(self.names))
        return BusState(
            now.position_rad,
            nothing if now.current_ma is None else now.current_ma,
            nothing if now.temperature_c is None else now.temperature_c,
            now.state not in ("ESTOP", "BOOT"),
            now.bad_frames + self._need_link().reader.bad_frames,
        )

    def write_goals(self, goal_rad: Array) -> None:
        lower, upper = self._limits.lower_rad, self._limits.upper_rad
        self._goal = checked_goals(self.names, goal_rad, lower, upper)
        self._require_movable()
        self._pump()

    def torque(self, on: bool) -> None:
        self._goal = None
        if not on:
            self._stream = None
            self._repeat_until(Estop(), lambda state: state is State.ESTOP)
            return
        state = self._state
        if state in _LATCHED:
            self._restart_session()
            self._need_link().send(Clear())
            self._until(lambda: self._state not in _LATCHED, "cannot be cleared")
        self._require_movable()

    def watchdog(self, timeout_s: float) -> bool:
        """The firmware's own is half a second and always on: True for that and more."""
        return timeout_s >= SILENCE_S

    def close(self) -> None:
        self._link = self._stream = None
        self._line.close()

    @property
    def arrived(self) -> bool:
        """Whether the latest goal is reached, or there is none."""
        return self._stream is None and self._goal is None

    def sample(self) -> Sample:
        """The latest telemetry."""
        assert self._telemetry is not None
        return to_sample(self._telemetry, self._need_link().record.resends, 0, self._health)

    @property
    def _state(self) -> State:
        return State.BOOT if self._telemetry is None else State(self._telemetry.state)

    def _need_link(self) -> Link:
        if self._link is None:
            raise PortMissing("the controller's line is closed; open it first")
        return self._link

    def _pump(self) -> None:
        """Send what fits, hear what came, and set off for a goal that waits."""
        if self._stream is None and self._goal is not None and self._state is State.READY:
            self._set_off(self._goal)
        if self._stream is None:
            for msg in self._need_link().poll():
                self._note(msg)
            return
        try:
            self._stream.step()
        except (ControllerHeld, ControllerFault):
            self._stream = self._goal = None
            if self._telemetry is not None and self._telemetry.cause == Cause.SILENCE:
                self._require_movable()
            raise
        if self._stream.arrived:
            self._stream = None

    def _set_off(self, goal: Array) -> None:
        self._goal = None
        link, welcome, last = self._need_link(), self._welcome, self._telemetry
        assert welcome is not None and last is not None
        present = np.array(last.command_urad) / COUNTS_PER_UNIT
        still = np.zeros((1, len(goal)))
        knots = approach(
            present, Knots(np.zeros(1), goal[None], still, still), self._limits, _SHARE
        )
        if len(knots.time_s) > 1:
            wire = to_wire(knots, welcome.buffer_knots)
            watch = Watch(lambda _: None, lambda: 0)
            self._stream = KnotStream(
                link, welcome.buffer_knots, self.names, wire, watch, self._note
            )

    def _note(self, msg: object) -> None:
        if isinstance(msg, Telemetry):
            self._telemetry = msg
            self._seen += 1
        elif isinstance(msg, Health):
            self._health = msg
        elif isinstance(msg, Refused):
            raise CommandRefused("the controller refused a command in this state")

    def _require_movable(self) -> None:
        state, cause = self._state, self._cause
        if state is State.HOLD and cause is Cause.SILENCE:
            raise WatchdogTripped(
                f"the controller heard nothing for {SILENCE_S:g} s and stopped by itself; start anew"
            )
        if state in _LATCHED:
            raise ControllerHeld(
                f"the controller is in {state.name} ({cause.name.lower()}); clear it"
            )

    @property
    def _cause(self) -> Cause:
        return Cause.NONE if self._telemetry is None else Cause(self._telemetry.cause)

    def _until_next_telemetry(self) -> None:
        seen = self._seen
        self._until(lambda: self._seen > seen, "sends no telemetry")

    def _until(self, reached: Callable[[], bool], failure: str) -> None:
        deadline = self._clock() + _ANSWER_S
        while True:
            self._pump()
            if reached():
                return
            if self._clock() > deadline:
                raise ControllerSilent(f"the controller answers, but {failure}")

    def _repeat_until(self, command: Estop, reached: Callable[[State], bool]) -> None:
        """Send what may get lost until telemetry shows that it was obeyed."""
        deadline, told_at = self._clock() + _ANSWER_S, float("-inf")
        while not reached(self._state):
            if self._clock() > deadline:
                raise ControllerSilent(
                    "the controller did not confirm the stop; cut the motors' power"
                )
            if self._clock() - told_at >= _REPEAT_S:
                told_at = self._clock()
                self._need_link().send_now(command)
            self._pump()

    def _restart_session(self) -> None:
        """A refusal stands until the next Hello, so what follows a stop begins with one."""
        link = self._need_link()
        self._link, self._welcome = handshake(
            link.transport, self._limits, self._clock, self._patience_s
        )
        self._telemetry = None
        self._until(lambda: self._telemetry is not None, "sends no telemetry")
