"""How motors hang on their bus: which id pulls which tendon, which way round, through what gear."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from fpcad.spec.base import Positive, SpecModel

MOTORS_PER_FINGER = 3

ServoId = Annotated[int, Field(ge=0, le=252)]
Sign = Literal[-1, 1]


class Wiring(SpecModel):
    """Ids, signs and gears of the motors; what is measured is in the calibration, not here."""

    baud_rate: Annotated[int, Field(ge=9600, le=4_000_000)] = 1_000_000
    """Speed of the servo bus [bit/s]."""
    ids: dict[str, tuple[ServoId, ServoId, ServoId]] = {}
    """Bus ids of m1, m2, m3 by finger; fingers left out are numbered in order from 1 on."""
    signs: dict[str, tuple[Sign, Sign, Sign]] = {}
    """Whether motors turn as their spools do (1) or against them (-1), by finger; 1 by default."""
    gear_ratios: dict[str, tuple[Positive, Positive, Positive]] = {}
    """Turns of a motor for one turn of its spool, by finger; 1 by default."""

    def numbers(self, fingers: tuple[str, ...]) -> tuple[int, ...]:
        """Ids of all motors in the order of the fingers."""
        counted = {
            finger: tuple(range(1 + MOTORS_PER_FINGER * i, 4 + MOTORS_PER_FINGER * i))
            for i, finger in enumerate(fingers)
        }
        return tuple(n for finger in fingers for n in self.ids.get(finger, counted[finger]))

    def directions(self, fingers: tuple[str, ...]) -> tuple[int, ...]:
        """Signs of all motors in the order of the fingers."""
        return tuple(s for finger in fingers for s in self.signs.get(finger, (1, 1, 1)))

    def ratios(self, fingers: tuple[str, ...]) -> tuple[float, ...]:
        """Gear ratios of all motors in the order of the fingers."""
        return tuple(r for finger in fingers for r in self.gear_ratios.get(finger, (1.0, 1.0, 1.0)))
