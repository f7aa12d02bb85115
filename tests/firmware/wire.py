"""A controller at the end of a serial line, to which single messages are put."""

from __future__ import annotations

import time

from fpcad.run.codec import KINDS, decode, encode
from fpcad.run.framing import Frame, FrameReader, encode_frame
from fpcad.run.messages import (
    Ack,
    Arm,
    Calibrate,
    Clear,
    Estop,
    Health,
    Hello,
    Hold,
    Home,
    Ping,
    Pong,
    Start,
    State,
    Telemetry,
    Welcome,
)
from fpcad.run.port import SerialTransport

PATIENCE_S = 3.0


class WireBench:
    """The counterpart of the bench in tests/run/test_states.py, which holds its controller."""

    def __init__(self, line: SerialTransport) -> None:
        self._line = line
        self._reader = FrameReader()
        self.session = 0
        self.seq = 0
        self.last = None

    def open(self) -> Welcome:
        """A new session; a controller that boots is asked again."""
        self.session, self.seq = self.session % 0xFFFF + 1, 0
        self._line.write(b"\0")
        for _ in range(10):
            answer = self.ask(Hello(), patience_s=0.5)
            if isinstance(answer, Welcome):
                return answer
        raise AssertionError("no answer to Hello")

    def ask(self, message, session=None, patience_s=PATIENCE_S):
        """The answer to one message, which is no telemetry."""
        kind = KINDS[type(message)]
        session = session or self.session
        frame = Frame(kind.code, self.seq, session, encode(message))
        self._line.write(encode_frame(frame))
        self.seq += kind.sequenced
        # A controller that was slow to answer a Hello answers its repeat as well.
        unasked = Telemetry | Health if isinstance(message, Hello) else Telemetry | Health | Welcome
        return self.wait_for(lambda m: not isinstance(m, unasked), patience_s, session)

    def wait_for(self, wanted, patience_s=PATIENCE_S, session=None):
        """The next message that is wanted, of one session or of any."""
        deadline = time.monotonic() + patience_s
        while time.monotonic() < deadline:
            for frame in self._reader.feed(self._line.read()):
                message = decode(frame.kind, frame.payload)
                self.last = message if isinstance(message, Telemetry) else self.last
                if session in (None, frame.session) and wanted(message):
                    return message
        return None

    def stay_until(self, wanted, patience_s=10.0):
        """The next message that is wanted, while the controller hears that its host is there."""
        deadline = time.monotonic() + patience_s
        while time.monotonic() < deadline:
            ping = Frame(KINDS[Ping].code, 0, self.session, encode(Ping(1)))
            self._line.write(encode_frame(ping))
            found = self.wait_for(wanted, patience_s=0.1)
            if found is not None:
                return found
        raise AssertionError(f"waited in vain; last: {self.last}")

    def now(self) -> Telemetry:
        """The next telemetry."""
        found = self.wait_for(lambda m: isinstance(m, Telemetry))
        assert found is not None
        return found

    def into(self, state, knots) -> None:
        """Bring any controller that is homed into a state, by commands alone."""
        self.open()
        self.ask(Estop())  # a run keeps its session, and this alone ends it from another one
        self.open()
        cleared = self.ask(Clear())
        assert isinstance(cleared, Ack), cleared
        if cleared.state == State.IDLE:  # a search for zeros was broken off before
            assert isinstance(self.ask(Calibrate((0,) * 12)), Ack)
        if state in (State.IDLE, State.HOMING):
            assert isinstance(self.ask(Home()), Ack)
        if state is State.IDLE:
            assert isinstance(self.ask(Hold()), Ack)
        if state in (State.ARMED, State.RUNNING):
            for message in (Arm(), *knots):
                answer = self.ask(message)
                assert isinstance(answer, Ack), (message, answer)
        if state is State.RUNNING:
            pong = self.ask(Ping(0))
            assert isinstance(pong, Pong)
            assert isinstance(self.ask(Start(pong.device_us + 200_000)), Ack)
        if state in (State.HOLD, State.ESTOP):
            assert isinstance(self.ask(Hold() if state is State.HOLD else Estop()), Ack)
