"""What is bought: bearings, pins, screws, inserts, nuts, tendons, tubes, motors, flanges; data/*.csv has the sizes."""

from __future__ import annotations

import csv
import math
from functools import cache
from importlib.resources import files
from typing import TypeVar

from pydantic import BaseModel, ConfigDict, Field, field_validator

from fpcad.errors import MakeError
from fpcad.spec.faults import near_miss

STEEL_G_MM3 = 7.85e-3
BRASS_G_MM3 = 8.5e-3


class Row(BaseModel):
    """One row of a table; lengths in mm, forces in N."""

    model_config = ConfigDict(frozen=True, extra="forbid", str_min_length=1)

    size: str
    source: str


class Bearing(Row):
    """A ball bearing, or a plain bush of the same use."""

    kind: str
    bore_mm: float = Field(gt=0)
    outer_mm: float = Field(gt=0)
    width_mm: float = Field(gt=0)
    static_load_n: float = Field(gt=0)
    mass_g: float = Field(gt=0)


class _InLengths(Row):
    lengths_mm: tuple[float, ...]

    @field_validator("lengths_mm", mode="before")
    @classmethod
    def _split(cls, text: str) -> tuple[float, ...]:
        return tuple(map(float, text.split()))

    def shortest(self, at_least_mm: float) -> float:
        """Shortest length that is sold and not below `at_least_mm` [mm]."""
        fitting = [length for length in self.lengths_mm if length >= at_least_mm - 1e-9]
        if not fitting:
            raise MakeError(f"{self.size}: none is sold of {at_least_mm:.1f} mm or longer")
        return min(fitting)

    def longest(self, at_most_mm: float) -> float:
        """Longest length that is sold and not above `at_most_mm` [mm]."""
        fitting = [length for length in self.lengths_mm if length <= at_most_mm + 1e-9]
        if not fitting:
            raise MakeError(f"{self.size}: none is sold of {at_most_mm:.1f} mm or shorter")
        return max(fitting)


class Pin(_InLengths):
    """A dowel pin."""

    diameter_mm: float = Field(gt=0)
    bending_mpa: float = Field(gt=0)
    """Bending stress [MPa] that it may bear."""

    def mass_g(self, length_mm: float) -> float:
        """Mass [g] of a pin of steel, its chamfers neglected."""
        return math.pi / 4 * self.diameter_mm**2 * length_mm * STEEL_G_MM3


class Screw(_InLengths):
    """A socket head cap screw."""

    thread_mm: float = Field(gt=0)
    clearance_hole_mm: float = Field(gt=0)
    head_diameter_mm: float = Field(gt=0)
    head_height_mm: float = Field(gt=0)

    def mass_g(self, length_mm: float) -> float:
        """Mass [g] of shank and head, thread and socket taken as making up for each other."""
        quarter_pi = math.pi / 4
        shank = quarter_pi * self.thread_mm**2 * length_mm * 0.85
        head = quarter_pi * self.head_diameter_mm**2 * self.head_height_mm * 0.85
        return (shank + head) * STEEL_G_MM3


class Insert(Row):
    """A heat-set insert of brass."""

    thread_mm: float = Field(gt=0)
    outer_mm: float = Field(gt=0)
    length_mm: float = Field(gt=0)
    hole_mm: float = Field(gt=0)
    least_wall_mm: float = Field(gt=0)

    @property
    def mass_g(self) -> float:
        """Mass [g], its knurls neglected."""
        ring = math.pi / 4 * (self.outer_mm**2 - self.thread_mm**2)
        return ring * self.length_mm * BRASS_G_MM3


class Nut(Row):
    """A hexagon nut."""

    thread_mm: float = Field(gt=0)
    across_flats_mm: float = Field(gt=0)
    height_mm: float = Field(gt=0)

    @property
    def mass_g(self) -> float:
        """Mass [g] of a nut of steel, its chamfers neglected."""
        hexagon = math.sqrt(3) / 2 * self.across_flats_mm**2
        hole = math.pi / 4 * self.thread_mm**2
        return (hexagon - hole) * self.height_mm * STEEL_G_MM3


class Tendon(Row):
    """A braided line."""

    diameter_mm: float = Field(gt=0)
    breaking_n: float = Field(gt=0)
    knot_share: float = Field(gt=0, le=1)
    """Share of the breaking load that a good knot keeps."""
    tension_stiffness_n: float = Field(gt=0)
    """EA: force per unit strain [N]."""


class Metal(Row):
    """What a part that is not printed at home is made of."""

    density_g_cm3: float = Field(gt=0)
    yield_mpa: float = Field(gt=0)


class Tube(Row):
    """A tube that tendons run in."""

    inner_mm: float = Field(gt=0)
    outer_mm: float = Field(gt=0)


class Flange(Row):
    """The hand's side of a robot's mechanical interface: a disc with a boss and a circle of screws."""

    outer_mm: float = Field(gt=0)
    circle_mm: float = Field(gt=0)
    """Diameter of the circle of the screws."""
    screws: int = Field(ge=3)
    screw: str
    boss_mm: float = Field(gt=0)
    """Diameter of the boss that centres it."""
    boss_height_mm: float = Field(gt=0)
    disc_mm: float = Field(gt=0)
    """Thickness of the disc under the screws' heads."""


class MotorBody(BaseModel):
    """Envelope of a motor: width x height across the shaft, depth along it, horn included.

    The horn stands out of one face; its screws sit on a circle about the shaft.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    type: str
    width_mm: float = Field(gt=0)
    height_mm: float = Field(gt=0)
    depth_mm: float = Field(gt=0)
    shaft_from_end_mm: float = Field(gt=0)
    """From the nearer end of the height to the shaft's axis."""
    horn_height_mm: float = Field(gt=0)
    """Of the depth: what the horn stands out."""
    horn_diameter_mm: float = Field(gt=0)
    horn_circle_mm: float = Field(gt=0)
    """Diameter of the circle of the horn's four screws."""
    horn_screw: str
    """Row of the table of screws; so is the next one."""
    centre_screw: str
    """The screw along the shaft, which holds the horn."""
    gap_mm: float = Field(gt=0)
    """Room that a printed pocket leaves on each side."""
    source: str


TABLES: dict[str, type[BaseModel]] = {
    "bearings": Bearing,
    "pins": Pin,
    "screws": Screw,
    "inserts": Insert,
    "nuts": Nut,
    "tendons": Tendon,
    "tubes": Tube,
    "metals": Metal,
    "flanges": Flange,
    "motor_bodies": MotorBody,
}

T = TypeVar("T", bound=BaseModel)


@cache
def table(name: str) -> dict[str, BaseModel]:
    """Every row of a table by its size (motor bodies by their type), in the file's order."""
    text = (files("fpcad") / "data" / f"{name}.csv").read_text(encoding="utf-8")
    kind, lines = TABLES[name], csv.DictReader(text.splitlines())
    rows = [kind.model_validate(line) for line in lines]
    return {getattr(row, "size", None) or getattr(row, "type", ""): row for row in rows}


def lookup(name: str, kind: type[T], size: str) -> T:
    """One row of a table, as its type; :class:`fpcad.errors.MakeError` where it has none."""
    row = table(name).get(size)
    if not isinstance(row, kind):
        hint = near_miss(table(name), size)
        raise MakeError(f'{name}: no "{size}"; it has {", ".join(table(name))}{hint}')
    return row
