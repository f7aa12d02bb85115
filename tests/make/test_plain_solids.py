"""Volumes and areas of plain solids against closed forms."""

from __future__ import annotations

import math

import pytest

from fpcad.make.documents.extras import (
    COUPON_PIN_MM,
    COUPON_STEPS_MM,
    PITCH_MM,
    THICK_MM,
    fit_coupon,
    tool_solid,
)
from fpcad.make.parts.solids import Solid, ball, box, prism, rod
from tests.make.hands import CLAY

SQUARE = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)]
TRIANGLE = [(0.0, 0.0), (4.0, 0.0), (0.0, 3.0)]


@pytest.mark.parametrize(
    ("solid", "volume", "area"),
    [
        (box((-1, -2, -3), (1, 2, 3)), 48.0, 88.0),
        (ball((1, 2, 3), 2.0), 32 / 3 * math.pi, 16 * math.pi),
        (rod((0, 0, 1), (3, 4, 1), 2.0), 20 * math.pi, 20 * math.pi + 8 * math.pi),
        (prism(SQUARE, 2.5), 60.0, 24.0 + 14.0 * 5),
        (prism(TRIANGLE, 1.0), 12.0, 12.0 + 12.0 * 2),
    ],
    ids=["box", "ball", "rod", "square", "triangle"],
)
def test_plain_solids_have_their_closed_forms(solid: Solid, volume: float, area: float):
    assert solid.Volume() == pytest.approx(volume, rel=1e-9)
    assert solid.Area() == pytest.approx(area, rel=1e-9)


def test_a_ring_has_the_difference_of_two_rods():
    ring = rod((0, 0, 0), (0, 0, 7), 5.0).cut(rod((0, 0, -1), (0, 0, 8), 3.0))
    assert ring.Volume() == pytest.approx(math.pi * 16 * 7, rel=1e-9)
    assert ring.Area() == pytest.approx(2 * math.pi * (5 + 3) * 7 + 2 * math.pi * 16, rel=1e-9)


def test_the_tool_is_its_cylinder():
    tool, solid = CLAY.tool, tool_solid(CLAY)
    length, r = tool.tip_mm - tool.back_mm, tool.radius_mm
    assert solid.Volume() == pytest.approx(math.pi * r**2 * length, rel=1e-9)
    assert solid.Area() == pytest.approx(2 * math.pi * r * (length + r), rel=1e-9)


def test_the_coupon_is_a_bar_less_its_holes_and_notch():
    radii = [(COUPON_PIN_MM + CLAY.print.clearance_mm + step) / 2 for step in COUPON_STEPS_MM]
    bar = PITCH_MM * (len(radii) + 1) * 10.0 * THICK_MM
    holes = sum(math.pi * r**2 * THICK_MM for r in radii)
    assert fit_coupon(CLAY).Volume() == pytest.approx(bar - holes - 2.0 * 1.0 * THICK_MM, rel=1e-9)
