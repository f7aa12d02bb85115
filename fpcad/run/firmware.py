"""The driver for controllers that speak fpcad's own protocol, simulated ones included."""

from __future__ import annotations

import time
from collections.abc import Callable

from fpcad.run.driver import Array, Played, Sample, Watch
from fpcad.run.errors import ControllerSilent, HeldByUser, NotReady
from fpcad.run.knots import to_wire
from fpcad.run.limits import JointLimits, to_counts
from fpcad.run.link import Clock
from fpcad.run.messages import Calibrate, Cause, Clear, Health, Reason, Refused, State, Telemetry
from fpcad.run.port import Transport
from fpcad.run.quintic import Knots
from fpcad.run.session import HANDSHAKE_S, handshake
from fpcad.run.stream import KnotStream, to_sample

_ANSWER_S = 1.0
_ADVICE = {
    State.HOLD: "it holds after a stop; look at the hand, then clear it",
    State.FAULT: "find the cause, then clear it",
    State.ESTOP: "torque is off; make sure that the hand may move, then clear it",
    State.IDLE: "its joints are not homed; run `fpcad home`",
    State.RUNNING: "it follows another run",
}


class FirmwareDriver:
    """A session with a controller that fits `limits`; `zeros_rad` (n,): its motors', if kept."""

    def __init__(
        self,
        transport: Transport,
        limits: JointLimits,
        clock: Clock = time.monotonic,
        patience_s: float = HANDSHAKE_S,
        zeros_rad: Array | None = None,
    ) -> None:
        self._limits = limits
        self._zeros = zeros_rad
        self._health: Health | None = None
        self._link, self._welcome = handshake(transport, limits, clock, patience_s)
        build = self._welcome.build.rstrip(b"\0").decode("ascii", "replace")
        self.identity = f"{build}, protocol {self._welcome.protocol}"

    def ready(self, *, clear: bool) -> Sample:
        """Where the joints are; raises :class:`NotReady` in any state but READY.

        A controller that does not know its motors' zeros is told those that were kept.
        """
        now = self._telemetry()
        if clear and now.state in (State.HOLD, State.FAULT, State.ESTOP):
            self._link.send(Clear())
            now = self._telemetry(until_acknowledged=True)
        if now.state == State.IDLE and self._zeros is not None:
            self._link.send(Calibrate(to_counts(self._zeros)))
            now = self._telemetry(until_acknowledged=True)
        if now.state != State.READY:
            raise self._not_ready(now)
        self._hear_health()
        return self._sample(now)

    def wait(self, until: Callable[[], bool], watch: Watch) -> None:
        """Hear telemetry, and answer Ctrl-C, while somebody puts the tool in."""
        while not until():
            if watch.stops() > 0:
                raise HeldByUser("stopped while the hand was open: it stays where it is, motors on")
            now = self._telemetry()
            watch.on_sample(self._sample(now))
            if now.state != State.READY:
                raise self._not_ready(now)

    def play(self, knots: Knots, watch: Watch) -> Played:
        """Stream the knots; docs/link.md tells how."""
        names = self._limits.names
        buffer_knots = self._welcome.buffer_knots
        wire = to_wire(knots, buffer_knots)
        return KnotStream(self._link, buffer_knots, names, wire, watch).play()

    def _sample(self, now: Telemetry) -> Sample:
        return to_sample(now, self._link.record.resends, 0, self._health)

    def _not_ready(self, now: Telemetry) -> NotReady:
        state, cause = State(now.state), Cause(now.cause)
        why = "" if cause is Cause.NONE else f" because of {cause.name.lower()}"
        advice = _ADVICE.get(state, "wait until it is")
        return NotReady(f"the controller is in {state.name}{why}, not READY: {advice}")

    def _refused(self, msg: Refused) -> NotReady:
        if Reason(msg.reason) is Reason.IMPLAUSIBLE:
            joint = self._limits.names[msg.joint]
            return NotReady(
                f"the kept zeros would put {joint} beyond its limits; home the hand with `fpcad home`"
            )
        return NotReady("the controller cannot be cleared while its joints move")

    def _hear_health(self) -> None:
        """Its first report tells the preload that the motors still hold."""
        deadline = self._link.clock() + _ANSWER_S
        while self._health is None and self._link.clock() < deadline:
            self._telemetry()

    def _telemetry(self, *, until_acknowledged: bool = False) -> Telemetry:
        deadline = self._link.clock() + _ANSWER_S
        while self._link.clock() < deadline:
            latest = None
            for msg in self._link.poll():
                if isinstance(msg, Refused):
                    raise self._refused(msg)
                if isinstance(msg, Health):
                    self._health = msg
                pending = until_acknowledged and self._link.unacknowledged()
                if isinstance(msg, Telemetry) and not pending:
                    latest = msg
            if latest is not None:
                return latest
        raise ControllerSilent("the controller answers, but sends no telemetry")
