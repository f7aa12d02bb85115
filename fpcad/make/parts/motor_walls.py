"""The motor box's walls between motors: ribs, lips and ledges that each motor sits in. docs/parts.md, "Motor box"."""

from __future__ import annotations

from collections.abc import Sequence

from fpcad.make.parts.motor_box_dimensions import LIP_MM, PLATE_MM, SLOT_MM, MotorBox
from fpcad.make.parts.solids import Solid, box, extruded

SUNK_MM = 1.0
"""What stands on the front plate begins this far inside of it."""
RIB_MM = 4.0
"""Length along the shafts of the ribs that keep the motors from turning."""
FOOT_MM = 3.0
"""Width of the ledges that the motors stand on."""
TONGUE_MM = 2.0
"""How far the walls between motors reach into the back plate."""


def separators(b: MotorBox, gap: float) -> list[Solid]:
    """Row +1: walls with ribs that hold the motors in x, lips that hold them in y, ledges for their fronts."""
    start, top = PLATE_MM - SUNK_MM, b.back_inner
    web = web_half(b)
    foot = web + b.body.gap_mm + FOOT_MM
    steps = _wall_steps(b, gap)
    inner, outer = steps[0][0], steps[-1][1]
    pieces = []
    for n in range(b.per_row + 1):
        x = (n - b.per_row / 2) * b.pitch
        pieces.append(extruded(_outline(x, steps, b.wall_x), start, top))
        left, right = max(x - foot, -b.wall_x), min(x + foot, b.wall_x)
        pieces.append(box((left, inner, start), (right, outer, b.motor_front)))
        if 0 < n < b.per_row:
            pieces += [
                box((x - web, low, top - SUNK_MM), (x + web, high, top + TONGUE_MM))
                for low, high in tongues(b)
            ]
    return pieces


def _wall_steps(b: MotorBox, gap: float) -> list[tuple[float, float, float]]:
    """From, to and half thickness of a wall between motors along y: lip, rib, web, rib, lip."""
    low, high, web = b.body_inner, b.body_outer, web_half(b)
    rib = web + b.body.gap_mm - gap
    lip = (b.pitch - b.body.horn_diameter_mm) / 2 - SLOT_MM
    return [
        (low - gap - LIP_MM, low - gap, lip),
        (low - gap, low + RIB_MM, rib),
        (low + RIB_MM, high - RIB_MM, web),
        (high - RIB_MM, high + gap, rib),
        (high + gap, high + gap + LIP_MM, lip),
    ]


def _outline(
    x: float, steps: Sequence[tuple[float, float, float]], wall_x: float
) -> list[tuple[float, float]]:
    """Outline in x, y of a wall about x, cut off where the box ends."""
    right, left = [], []
    for low, high, half in steps:
        right += [(min(x + half, wall_x), y) for y in (low, high)]
        left += [(max(x - half, -wall_x), y) for y in (low, high)]
    around = [*right, *reversed(left)]
    return [
        point for point, last in zip(around, [around[-1], *around], strict=False) if point != last
    ]


def tongues(b: MotorBox) -> list[tuple[float, float]]:
    """Ranges of y, in row +1, in which the walls between motors reach into the back plate."""
    low, high = b.body_inner, b.body_outer
    return [(low, low + RIB_MM), (high - RIB_MM, high)]


def inner_walls(b: MotorBox) -> list[float]:
    """X of the walls between motors."""
    return [(n - b.per_row / 2) * b.pitch for n in range(1, b.per_row)]


def web_half(b: MotorBox) -> float:
    """Half thickness of the walls between motors."""
    return (b.pitch - b.body.width_mm) / 2 - b.body.gap_mm


def in_row(solid: Solid, row: int) -> Solid:
    """What was made for row +1, in its own row."""
    return solid if row > 0 else solid.rotate((0, 0, 0), (0, 0, 1), 180.0)
