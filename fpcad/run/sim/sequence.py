"""The controller's end of the reliable link: frames in order, each once, or a refusal for good."""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum

from fpcad.run.framing import Frame
from fpcad.run.messages import Nak, Refused


class Done(Enum):
    """The answer that everything before `expected` is done."""

    DONE = 0


DONE = Done.DONE


class Sequence:
    """Sequence numbers of one session; they count modulo 2^16."""

    def __init__(self) -> None:
        self.expected = 0
        self._gap_reported = False
        self._refusal: Refused | None = None

    def take(
        self, frame: Frame, perform: Callable[[Frame], Refused | None]
    ) -> Done | Nak | Refused | None:
        """Perform the frame if it is next in line; what to answer.

        After a refusal nothing more is done in this session: whatever the host sent behind the
        refused frame was meant to follow it.
        """
        if self._refusal is not None:
            return self._refusal
        ahead = (frame.seq - self.expected) & 0xFFFF
        if ahead == 0:
            return self._perform_next(frame, perform)
        if ahead >= 0x8000:
            return DONE  # a repeat: its acknowledgement was lost
        if self._gap_reported:
            return None
        self._gap_reported = True
        return Nak(self.expected)

    def _perform_next(
        self, frame: Frame, perform: Callable[[Frame], Refused | None]
    ) -> Done | Refused:
        self._gap_reported = False
        self._refusal = perform(frame)
        if self._refusal is not None:
            return self._refusal
        self.expected = (self.expected + 1) & 0xFFFF
        return DONE
