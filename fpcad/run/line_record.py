"""What a line did to the frames, and whose fault it is that a controller heard too little."""

from __future__ import annotations

from dataclasses import dataclass

from fpcad.run.messages import Cause

STALL_S = 0.3
"""Longest pause of a host that says something every 25 ms; a longer one it has to answer for itself."""
_RECENT_S = 3.0
"""How far back a stall or a loss can be why a controller holds now: more than its buffer bridges."""


@dataclass
class LineRecord:
    """Counts of one session, and when the host and the line last failed."""

    resends: int = 0
    """Frames that were sent again."""
    unread_here: int = 0
    """Frames of the controller that could not be read."""
    _unread_there: int = 0
    _unread_at_first: int | None = None
    _looked_s: float | None = None
    _stalled_s: float = float("-inf")
    _resent_s: float = float("-inf")

    @property
    def unread(self) -> int:
        """Frames that one of the two sides could not read."""
        return self.unread_here + self._unread_there

    def look(self, now_s: float) -> None:
        """The host looks after the line; when it last did tells whether it stalled."""
        if self._looked_s is not None and now_s - self._looked_s > STALL_S:
            self._stalled_s = now_s
        self._looked_s = now_s

    def resent(self, now_s: float) -> None:
        """A frame was sent again."""
        self.resends += 1
        self._resent_s = now_s

    def hear_unread(self, count: int) -> None:
        """The controller tells how many frames it could not read since it started, modulo 2^16."""
        if self._unread_at_first is None:
            self._unread_at_first = count
        self._unread_there = (count - self._unread_at_first) & 0xFFFF

    def is_to_blame(self, cause: Cause, now_s: float) -> bool:
        """Whether the line starved a controller that holds for `cause`, and not the host.

        A host that spoke all the time and was not heard has a line that loses; so has one whose
        knots did not arrive though it sent them again.
        """
        if now_s - self._stalled_s <= _RECENT_S:
            return False
        if cause is Cause.SILENCE:
            return True
        return cause is Cause.UNDERRUN and now_s - self._resent_s <= _RECENT_S

    def __str__(self) -> str:
        return f"{self.resends} frames sent again, {self.unread} unreadable"
