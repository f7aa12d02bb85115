"""One kind of damage to a line at a time, counted; seeds make each repeatable."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass

Frames = list[bytes]


@dataclass
class FrameDamage:
    """Damages whole frames with probability `rate` each; counts those that cannot arrive."""

    kind: str
    rate: float
    seed: int
    lost: int = 0

    def __post_init__(self) -> None:
        self._chance = random.Random(self.seed)
        self._late: Frames = []
        self._act: Callable[[bytes], Frames] = getattr(self, f"_{self.kind}")

    def __call__(self, data: bytes) -> bytes:
        out: Frames = []
        for piece in data.split(b"\0")[:-1]:
            frame = piece + b"\0"
            if self._chance.random() < self.rate:
                out += self._act(frame)
            else:
                out += [frame, *self._late]
                self._late = []
        return b"".join(out)

    def _drop(self, frame: bytes) -> Frames:
        self.lost += len(frame) > 1
        return []

    def _duplicate(self, frame: bytes) -> Frames:
        return [frame, frame]

    def _insert(self, frame: bytes) -> Frames:
        self.lost += len(frame) > 1
        at = self._chance.randrange(len(frame))
        return [frame[:at] + self._chance.randbytes(self._chance.randint(1, 9)) + frame[at:]]

    def _truncate(self, frame: bytes) -> Frames:
        """The tail is missing, delimiter and all, so that the next frame is spoilt as well."""
        self.lost += 2 * (len(frame) > 1)
        return [frame[: self._chance.randrange(len(frame))]]

    def _reorder(self, frame: bytes) -> Frames:
        # Go-back-N takes what overtakes for a loss.
        self.lost += len(frame) > 1
        self._late.append(frame)
        return []


KINDS = ("drop", "duplicate", "insert", "truncate", "reorder")
