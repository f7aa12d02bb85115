"""What the paper tells of its two experiments; to stand beside, never to be tuned to."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Published:
    """One experiment as published; shares in [0, 1]."""

    candidates: int
    calls: int
    occupied: float
    wielding: dict[str, float]
    """Share with a motion range above zero; `all` for all poses."""

    @property
    def efficiency(self) -> float:
        return self.candidates / self.calls


PLANE = Published(785, 78_511, 0.6850, {"carve": 1.0, "poke": 1.0, "press": 1.0, "all": 1.0})
FULL = Published(
    10_000, 21_969, 1.11e-6, {"carve": 0.9942, "poke": 1.0, "press": 1.0, "all": 0.9942}
)
