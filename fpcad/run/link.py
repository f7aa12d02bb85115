"""The host's end of the link: sequence numbers, acknowledgements, repeats, and when to give up."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from fpcad.run.codec import KINDS, MalformedMessage, decode, encode
from fpcad.run.errors import ControllerReset, LinkLost
from fpcad.run.framing import PROTOCOL_VERSION, Frame, FrameReader, encode_frame
from fpcad.run.line_record import LineRecord
from fpcad.run.messages import Ack, Nak, NoSession, Ping, Pong, Refused, Telemetry
from fpcad.run.port import Transport

Clock = Callable[[], float]
"""Monotonic time [s]."""

MAX_IN_FLIGHT = 256
"""Bytes on the way at once: 22 ms at 115200 baud, which bounds how long a stop can take."""
_URGENT_RESERVE = 40
"""Part of it that sequenced frames leave to Ping, Hold and Estop."""
QUIET_S = 0.025
"""Time without any other frame after which the host says that it is there; a stall of 0.45 s then
stays below the half second after which the controller stops."""
SILENCE_S = 0.45
"""A controller sends telemetry every 20 ms; this long without any means that it is gone."""
MAX_FAILURES = 8
_FIRST_RTO_S, _FLOOR_RTO_S, _CEILING_RTO_S = 0.2, 0.025, 0.2


@dataclass
class RoundTrip:
    """Time after which a frame counts as lost: RFC 6298 with a floor of 25 ms."""

    smoothed_s: float | None = None
    deviation_s: float = 0.0

    def add(self, sample_s: float) -> None:
        """Take one measured round trip [s] into account."""
        if self.smoothed_s is None:
            self.smoothed_s, self.deviation_s = sample_s, sample_s / 2
            return
        self.deviation_s = 0.75 * self.deviation_s + 0.25 * abs(self.smoothed_s - sample_s)
        self.smoothed_s = 0.875 * self.smoothed_s + 0.125 * sample_s

    def timeout_s(self, failures: int) -> float:
        """Patience [s] after `failures` repeats in vain."""
        if self.smoothed_s is None:
            return _FIRST_RTO_S
        patience = max(self.smoothed_s + 4 * self.deviation_s, _FLOOR_RTO_S)
        return min(patience * 2**failures, _CEILING_RTO_S)


@dataclass
class _Sent:
    seq: int
    data: bytes
    message: Any
    at_s: float
    repeated: bool = False


@dataclass
class Link:
    """One session with a controller. `clock` and `transport` are all that it knows of the world."""

    transport: Transport
    session: int
    clock: Clock = time.monotonic
    foreign_version: int | None = None
    """Protocol version of a valid frame that is not ours, once one has come."""
    watch_silence: bool = False
    reader: FrameReader = field(default_factory=FrameReader)
    record: LineRecord = field(default_factory=LineRecord)

    def __post_init__(self) -> None:
        self.heard_at_s = self.clock()
        self.round_trip = RoundTrip()
        self._window: deque[_Sent] = deque()
        self._next_seq = 0
        self._failures = 0
        self._waiting_since_s = 0.0
        self._wrote_at_s = float("-inf")

    def room_for(self, message: Any) -> bool:
        """Whether `message` may be sent now without more than `MAX_IN_FLIGHT` bytes on the way."""
        used = sum(len(sent.data) for sent in self._window)
        return used + len(self._frame(message, 0)) <= MAX_IN_FLIGHT - _URGENT_RESERVE

    def unacknowledged(self, kind: type | None = None) -> int:
        """Sequenced messages on the way, of one class or of all."""
        return sum(kind is None or isinstance(sent.message, kind) for sent in self._window)

    def send(self, message: Any) -> None:
        """Send a sequenced message; it is repeated until it is acknowledged."""
        if not KINDS[type(message)].sequenced:
            raise ValueError(f"{type(message).__name__} is not sequenced")
        data = self._frame(message, self._next_seq)
        now = self.clock()
        if not self._window:
            self._waiting_since_s = now
        self._window.append(_Sent(self._next_seq, data, message, now))
        self._next_seq = (self._next_seq + 1) & 0xFFFF
        self._write(data)

    def send_now(self, message: Any) -> None:
        """Send a message that is acted on at receipt; it may get lost."""
        if KINDS[type(message)].sequenced:
            raise ValueError(f"{type(message).__name__} is sequenced")
        self._write(self._frame(message, 0))

    def poll(self) -> list[Any]:
        """Messages that came, after the link's own work: acknowledgements, repeats, pings.

        Raises :class:`LinkLost` after 8 repeats in vain or 0.45 s of silence, and
        :class:`ControllerReset` when the controller no longer knows the session.
        """
        frames = self.reader.feed(self.transport.read())
        self.record.look(self.clock())  # a process may be stopped in the midst of reading
        self.record.unread_here = self.reader.bad_frames
        messages = [msg for frame in frames if (msg := self._accept(frame)) is not None]
        # Silence is judged after reading, so that a host that stalled itself blames nobody.
        if self.watch_silence and self.clock() - self.heard_at_s > SILENCE_S:
            raise LinkLost(
                f"nothing heard from the controller for {SILENCE_S * 1e3:.0f} ms ({self.record})"
            )
        self._repeat_if_due()
        self._ping_if_due()
        return messages

    def _frame(self, message: Any, seq: int) -> bytes:
        code = KINDS[type(message)].code
        return encode_frame(Frame(code, seq, self.session, encode(message)))

    def _accept(self, frame: Frame) -> Any:
        if frame.version != PROTOCOL_VERSION:
            self.foreign_version = frame.version
            return None
        if frame.session != self.session:
            return None
        try:
            msg = decode(frame.kind, frame.payload)
        except MalformedMessage:
            self.reader.bad_frames += 1
            return None
        self.heard_at_s = self.clock()
        self._note(msg)
        return msg

    def _note(self, msg: Any) -> None:
        if isinstance(msg, Ack):
            self._release(msg.expected)
        elif isinstance(msg, Nak):
            self._release(msg.expected)
            if self._window and self._window[0].seq == msg.expected:
                self._repeat()
        elif isinstance(msg, Refused):
            self._release((msg.seq + 1) & 0xFFFF)
        elif isinstance(msg, Telemetry):
            self.record.hear_unread(msg.bad_frames)
        elif isinstance(msg, Pong):
            self.round_trip.add(max(self.clock() - msg.host_us / 1e6, 0.0))
        elif isinstance(msg, NoSession) and self.watch_silence:
            raise ControllerReset("the controller restarted in mid-run; the run is not resumed")

    def _release(self, expected: int) -> None:
        """Forget frames before `expected`; sequence numbers compare modulo 2^16."""
        now = self.clock()
        while self._window and 0 < (expected - self._window[0].seq) & 0xFFFF < 0x8000:
            sent = self._window.popleft()
            if not sent.repeated:
                self.round_trip.add(now - sent.at_s)
            self._failures = 0
            self._waiting_since_s = now

    def _repeat_if_due(self) -> None:
        patience = self.round_trip.timeout_s(self._failures)
        if not self._window or self.clock() - self._waiting_since_s < patience:
            return
        self._failures += 1
        if self._failures > MAX_FAILURES:
            raise LinkLost(
                f"the controller acknowledged nothing after {MAX_FAILURES} repeats ({self.record})"
            )
        self._repeat()

    def _repeat(self) -> None:
        for sent in self._window:
            sent.repeated = True
            self.record.resent(self.clock())
            self._write(sent.data)
        self._waiting_since_s = self.clock()

    def _ping_if_due(self) -> None:
        now = self.clock()
        if self.watch_silence and now - self._wrote_at_s >= QUIET_S:
            self.send_now(Ping(int(now * 1e6)))

    def _write(self, data: bytes) -> None:
        self._wrote_at_s = self.clock()
        self.transport.write(data)
