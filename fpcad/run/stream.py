"""Streams knots to a controller: prefill, start, as many as fit, end; or a stop in order."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable
from contextlib import suppress
from typing import Any, NoReturn

import numpy as np

from fpcad.run.codec import CLASSES
from fpcad.run.device_clock import DeviceClock
from fpcad.run.driver import Played, Sample, Watch
from fpcad.run.errors import (
    CommandRefused,
    ControllerFault,
    ControllerHeld,
    HeldByUser,
    LinkLost,
    RunError,
    StartTooFar,
    StoppedByUser,
)
from fpcad.run.knots import WireKnots
from fpcad.run.limits import from_counts
from fpcad.run.link import Link
from fpcad.run.messages import (
    PRELOAD_URAD,
    Arm,
    Cause,
    End,
    Estop,
    Health,
    Hold,
    Knot,
    Reason,
    Refused,
    Start,
    State,
    Telemetry,
)

START_LEAD_S = 0.5
"""How far ahead the start lies: time enough for a stall of the host, or for repeats."""
_STOP_PERIOD_S = 0.05
_STOP_PATIENCE_S = 3.0


class KnotStream:
    """One motion on one link, from READY back to READY."""

    def __init__(
        self,
        link: Link,
        buffer_knots: int,
        joint_names: tuple[str, ...],
        wire: WireKnots,
        watch: Watch,
        on_message: Callable[[Any], None] = lambda _: None,
    ) -> None:
        self._link = link
        self._on_message = on_message
        self._joint_names = joint_names
        self._wire = wire
        self._watch = watch
        self._clock = DeviceClock()
        self._buffer = buffer_knots
        self._times_us = [knot.t_us for knot in wire.messages]
        self._left_behind = 0
        self._sent = 0
        self._prefill = min(buffer_knots, len(wire.messages))
        self._armed = self._started = self._ended = False
        self._last: Telemetry | None = None
        self._health: Health | None = None

    def play(self) -> Played:
        """Send all knots and wait until the last one is reached; raises a :class:`RunError`."""
        while not self.arrived:
            self.step()
        assert self._last is not None
        return Played(
            self._sent,
            self._link.record.resends,
            self._link.record.unread,
            self._wire.error_rad,
            State(self._last.state).name,
        )

    def step(self) -> None:
        """Send what fits, and hear what has come."""
        try:
            if self._watch.stops() > 0:
                self._hold()
            self._send_what_fits()
            for msg in self._link.poll():
                self._handle(msg)
        except BaseException:
            # Whatever went wrong here, the joints shall not go on. If the line is gone too, the
            # controller's own rule of silence stops them.
            with suppress(LinkLost):
                self._link.send_now(Hold())
            raise

    @property
    def arrived(self) -> bool:
        """Whether the last knot is reached."""
        last = self._last
        return (
            self._started
            and self._ended
            and not self._link.unacknowledged()
            and last is not None
            and last.state == State.READY
            and last.path_us >= self._wire.duration_us
        )

    def _send_what_fits(self) -> None:
        while (msg := self._next()) is not None and self._link.room_for(msg):
            self._link.send(msg)
            if isinstance(msg, Arm):
                self._armed = True
            elif isinstance(msg, Knot):
                self._sent += 1
            elif isinstance(msg, Start):
                self._started = True
            else:
                self._ended = True

    def _next(self) -> Any:
        """What to send next, or None while there is nothing to send or no room for it."""
        if not self._armed:
            return Arm()
        if self._sent == len(self._wire.messages) and not self._ended:
            return End(self._sent)
        if self._sent == self._prefill and not self._started:
            # A start before the prefill has arrived would be judged against what is queued.
            if not self._clock.ready or self._link.unacknowledged():
                return None
            return Start(self._clock.device_us(self._link.clock() + START_LEAD_S))
        if self._sent < len(self._wire.messages) and self._sent - self._left_behind < self._buffer:
            return self._wire.messages[self._sent]
        return None

    def _handle(self, msg: Any) -> None:
        if not isinstance(msg, Refused):  # refusals become errors here
            self._on_message(msg)
        if isinstance(msg, Telemetry):
            self._note(msg)
            if self._armed:
                self._require_motion_allowed(msg.state, msg.cause)
        elif isinstance(msg, Health):
            self._health = msg
        elif isinstance(msg, Refused):
            self._require_motion_allowed(msg.state, msg.cause)
            raise self._refusal(msg)

    def _note(self, msg: Telemetry) -> None:
        self._last = msg
        if self._started and msg.state == State.RUNNING:
            self._note_place(msg.path_us)
        self._clock.add(self._link.clock(), msg.device_us)
        self._watch.on_sample(to_sample(msg, self._link.record.resends, self._sent, self._health))

    def _note_place(self, path_us: int) -> None:
        """The controller forgets knots that the path has passed, but for the present segment's.

        This is a count that only grows, whatever comes late or twice; the free places in an answer
        that has been overtaken would promise room that there is no more.
        """
        # One microsecond less, since the place is told rounded.
        passed = bisect_right(self._times_us, path_us - 1) - 1
        self._left_behind = max(self._left_behind, min(passed, self._sent - 2))

    def _require_motion_allowed(self, state: int, cause: int) -> None:
        where = f"at {self._last.path_us / 1e6:.2f} s of the path" if self._last else "at the start"
        if state == State.FAULT:
            raise ControllerFault(f"the controller stopped {where}: {self._fault(cause)}")
        if state == State.HOLD:
            raise self._held(where, Cause(cause))
        if state == State.ESTOP:
            raise StoppedByUser(f"emergency stop {where}: torque is off, the hand lets go")

    def _held(self, where: str, cause: Cause) -> LinkLost | ControllerHeld:
        """A controller that a bad line starved is a lost link, not a host that came too late."""
        record = self._link.record
        said = f"the controller holds {where} ({cause.name.lower()}); the run is not resumed"
        if not record.is_to_blame(cause, self._link.clock()):
            return ControllerHeld(said)
        lost = LinkLost(f"the line lost too much ({record}): {said}")
        lost.leaving(ControllerHeld.hand)
        return lost

    def _fault(self, cause: int) -> str:
        if cause != Cause.TRACKING or self._last is None:
            return Cause(cause).name.lower()
        behind = abs(from_counts(self._last.position_urad) - from_counts(self._last.command_urad))
        worst = int(behind.argmax())
        return f"{self._joint_names[worst]} does not follow ({behind[worst]:.3f} rad behind)"

    def _refusal(self, msg: Refused) -> RunError:
        reason = Reason(msg.reason)
        joint = self._joint_names[msg.joint] if msg.joint < len(self._joint_names) else "?"
        if reason is Reason.TOO_FAR_FROM_START:
            return StartTooFar(f"{joint} is more than 2 degrees from where the motion starts")
        command = CLASSES[msg.command].__name__ if msg.command in CLASSES else hex(msg.command)
        place = f" ({joint})" if "LIMIT" in reason.name else ""
        return CommandRefused(
            f"the controller refused {command}: {reason.name.lower().replace('_', ' ')}{place}"
        )

    def _hold(self) -> NoReturn:
        """Stop along the path and wait until the controller says that the joints stand."""
        deadline = self._link.clock() + _STOP_PATIENCE_S
        told, told_at = None, float("-inf")
        while self._link.clock() < deadline:
            command = Estop if self._watch.stops() > 1 else Hold
            now = self._link.clock()
            # Stops may get lost, so they are repeated; both are idempotent.
            if command is not told or now - told_at >= _STOP_PERIOD_S:
                told, told_at = command, now
                self._link.send_now(command())
            for msg in self._link.poll():
                if isinstance(msg, Telemetry):
                    self._note(msg)
                    self._raise_when_stopped(msg)
        raise LinkLost("the controller did not confirm the stop; cut the motors' power")

    def _raise_when_stopped(self, msg: Telemetry) -> None:
        where = f"at {msg.path_us / 1e6:.2f} s of {self._wire.duration_us / 1e6:.2f} s"
        if msg.state == State.ESTOP:
            raise StoppedByUser(f"stopped {where}: torque is off, the hand lets go")
        if msg.state == State.FAULT:
            self._require_motion_allowed(msg.state, msg.cause)
        if msg.state == State.HOLD and msg.rate_permille == 0 and self._watch.stops() < 2:
            raise HeldByUser(f"held {where}: the hand keeps its grip, motors stay on")


def to_sample(
    msg: Telemetry, resends: int, knots_sent: int, health: Health | None = None
) -> Sample:
    """Telemetry in SI units."""
    return Sample(
        msg.device_us / 1e6,
        msg.path_us / 1e6,
        State(msg.state).name,
        Cause(msg.cause).name,
        from_counts(msg.position_urad),
        from_counts(msg.command_urad),
        msg.queued_knots,
        msg.bad_frames,
        resends,
        knots_sent,
        None if health is None else np.array(health.current_ma, dtype=float),
        None if health is None else np.array(health.temperature_c, dtype=float),
        None if health is None else from_counts(health.preload_20urad) * PRELOAD_URAD,
        0 if health is None else health.gaps,
    )
