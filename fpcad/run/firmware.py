"""The driver for controllers that speak fpcad's own protocol, simulated ones included."""

from __future__ import annotations

import time

from fpcad.run.driver import Played, Sample, Watch
from fpcad.run.errors import ControllerSilent, NotReady
from fpcad.run.knots import to_wire
from fpcad.run.limits import JointLimits
from fpcad.run.link import Clock
from fpcad.run.messages import Cause, Clear, Refused, State, Telemetry
from fpcad.run.port import Transport
from fpcad.run.quintic import Knots
from fpcad.run.session import HANDSHAKE_S, handshake
from fpcad.run.stream import KnotStream, to_sample

_ANSWER_S = 1.0
_ADVICE = {
    State.HOLD: "it holds after a stop; look at the hand, then clear it",
    State.FAULT: "find the cause, then clear it",
    State.ESTOP: "torque is off; make sure that the hand may move, then clear it",
    State.IDLE: "its joints are not homed",
    State.RUNNING: "it follows another run",
}


class FirmwareDriver:
    """A session with a controller that fits `limits`."""

    def __init__(
        self,
        transport: Transport,
        limits: JointLimits,
        clock: Clock = time.monotonic,
        patience_s: float = HANDSHAKE_S,
    ) -> None:
        self._limits = limits
        self._link, self._welcome = handshake(transport, limits, clock, patience_s)
        build = self._welcome.build.rstrip(b"\0").decode("ascii", "replace")
        self.identity = f"{build}, protocol {self._welcome.protocol}"

    def ready(self, *, clear: bool) -> Sample:
        """Where the joints are; raises :class:`NotReady` in any state but READY."""
        now = self._telemetry()
        if clear and now.state in (State.HOLD, State.FAULT, State.ESTOP):
            self._link.send(Clear())
            now = self._telemetry(until_acknowledged=True)
        if now.state != State.READY:
            state, cause = State(now.state), Cause(now.cause)
            why = "" if cause is Cause.NONE else f" because of {cause.name.lower()}"
            advice = _ADVICE.get(state, "wait until it is")
            raise NotReady(f"the controller is in {state.name}{why}, not READY: {advice}")
        return to_sample(now, self._link.resends, 0)

    def play(self, knots: Knots, watch: Watch) -> Played:
        """Stream the knots; docs/link.md tells how."""
        names = self._limits.names
        buffer_knots = self._welcome.buffer_knots
        wire = to_wire(knots, buffer_knots)
        return KnotStream(self._link, buffer_knots, names, wire, watch).play()

    def _telemetry(self, *, until_acknowledged: bool = False) -> Telemetry:
        deadline = self._link.clock() + _ANSWER_S
        while self._link.clock() < deadline:
            for msg in self._link.poll():
                if isinstance(msg, Refused):
                    raise NotReady("the controller cannot be cleared while its joints move")
                pending = until_acknowledged and self._link.unacknowledged()
                if isinstance(msg, Telemetry) and not pending:
                    return msg
        raise ControllerSilent("the controller answers, but sends no telemetry")
