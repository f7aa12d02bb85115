"""A session whose line breaks after so many bytes: what host and hand do then."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from fpcad.run.driver import Watch
from fpcad.run.errors import LinkLost, RunError
from fpcad.run.firmware import FirmwareDriver
from fpcad.run.messages import State
from tests.firmware.core import core_controller
from tests.run.fixtures import hand_limits, swing
from tests.run.virtual import VirtualLine

MOTION = swing(0.5, 13, amplitude=0.02)
DIRECTIONS = ("out", "in")


class CutLine(VirtualLine):
    """Breaks after so many bytes in one direction, with an error of the port or in silence."""

    limit: int = 10**9
    direction: str = "out"
    loud: bool = True
    passed: int = 0

    def _spend(self, data: bytes, direction: str) -> bytes:
        if direction != self.direction:
            return data if self.connected else b""
        left = max(self.limit - self.passed, 0)
        self.passed += len(data)
        if self.passed > self.limit:
            self.connected = False
        return data[:left]

    def write(self, data: bytes) -> None:
        if not self.connected and self.loud:
            raise LinkLost("the line broke")
        kept = self._spend(data, "out")
        self.log.append(data)
        self._to_device += kept
        self._deliver(None)

    def read(self) -> bytes:
        if not self.connected and self.loud:
            raise LinkLost("the line broke")
        return self._spend(super().read(), "in")


@dataclass
class Cuts:
    """What many cuts have led to."""

    sessions: int = 0
    ends: Counter[str] = field(default_factory=Counter)
    slowest_host_s: float = 0.0
    slowest_stop_s: float = 0.0

    def add(self, cut: int, direction: str, loud: bool) -> None:
        """Break one session and check what both sides do."""
        line = _line(cut, direction, loud)
        broke_at, stands_at = [], []

        def note(line: VirtualLine) -> None:
            if not line.connected and not broke_at:
                broke_at.append(line.now_s)
            stands = line.device.state is not State.RUNNING and line.device.follower.rate == 0
            if broke_at and stands and not stands_at:
                stands_at.append(line.now_s)

        line.on_tick = note
        self.ends[_session(line)] += 1
        ended = line.now_s
        line.let_pass(1.0)
        assert broke_at and stands_at, f"{direction} {cut}: no end"
        self.sessions += 1
        self.slowest_host_s = max(self.slowest_host_s, ended - broke_at[0])
        self.slowest_stop_s = max(self.slowest_stop_s, stands_at[0] - broke_at[0])
        assert self.slowest_host_s <= 1.0 and self.slowest_stop_s <= 0.6, f"{direction} {cut}"
        _require_reconnection(line)


def bytes_of_a_session(direction: str) -> int:
    """How many bytes go that way when nothing breaks."""
    line = _line(10**9, direction, True)
    assert _session(line) == "complete"
    return line.passed


def _line(cut: int, direction: str, loud: bool) -> CutLine:
    line = CutLine(core_controller())
    line.limit, line.direction, line.loud = cut, direction, loud
    return line


def _session(line: CutLine) -> str:
    try:
        driver = FirmwareDriver(line, hand_limits(), line.clock, patience_s=0.5)
        driver.ready(clear=False)
        driver.play(MOTION, Watch(lambda _sample: None, lambda: 0))
    except RunError as error:
        return type(error).__name__
    return "complete"


def _require_reconnection(line: CutLine) -> None:
    again = VirtualLine(line.device)
    assert FirmwareDriver(again, hand_limits(), again.clock).ready(clear=True).state == "READY"
