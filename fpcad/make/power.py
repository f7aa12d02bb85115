"""What feeds the motors: supply, fuse and wiring, sized by their stall current."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from importlib.resources import files

from fpcad.errors import MakeError
from fpcad.spec.catalogue import motor

SHARE_AT_STALL = 0.5
"""A grip loads some motors of a hand and not all: the supply is sized for half of them at stall."""
FUSES_A = (3, 5, 7.5, 10, 15, 20, 25, 30)
"""Blade fuses of ISO 8820-3."""
AMPERES_PER_MM2 = 10.0
"""Of short copper leads in free air."""
WIRES_MM2 = (0.5, 0.75, 1.0, 1.5, 2.5, 4.0)


@dataclass(frozen=True)
class Power:
    """What to buy beside the motors."""

    supply_v: float
    supply_a: float
    fuse_a: float
    wire_mm2: float
    adapter: str
    cable: str
    source: str


def power(motor_type: str, motors: int) -> Power:
    """Supply, fuse and leads for so many motors of a type of the catalogue."""
    text = (files("fpcad") / "data" / "power.csv").read_text(encoding="utf-8")
    rows = {row["type"]: row for row in csv.DictReader(text.splitlines())}
    if motor_type not in rows:
        raise MakeError(f'power: no row for "{motor_type}"; it has {", ".join(rows)}')
    row = rows[motor_type]
    current = motors * SHARE_AT_STALL * float(row["stall_current_a"])
    fuse = next((size for size in FUSES_A if size >= current), FUSES_A[-1])
    wire = next((size for size in WIRES_MM2 if size * AMPERES_PER_MM2 >= fuse), WIRES_MM2[-1])
    told = row["adapter"], row["cable"], row["source"]
    return Power(motor(motor_type).supply_v, float(math.ceil(current)), fuse, wire, *told)
