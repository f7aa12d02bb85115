"""What a design's numbers forbid is told without modelling anything."""

from __future__ import annotations

import pytest

from fpcad.errors import MakeError
from fpcad.make.gates.early import check_early
from tests.make.hands import CENTRE, CLAY, geometry_of, with_print

SHORT_AND_STEEP = (42.0, 50.0, 30.0, 16.0, 120.0, 0.0)


def with_rest(**angles_deg: float):
    posture = {**CLAY.hand.rest_posture_deg, **angles_deg}
    hand = CLAY.hand.model_copy(update={"rest_posture_deg": posture})
    return CLAY.model_copy(update={"hand": hand})


def test_the_centre_hand_passes():
    check_early(CLAY, geometry_of(CENTRE))


def test_fingers_that_cross_at_rest_are_told_with_the_depth():
    with pytest.raises(MakeError, match=r"thumb \w+ and middle \w+ overlap by \d+\.\d mm at rest"):
        check_early(CLAY, geometry_of(SHORT_AND_STEEP))


def test_another_rest_posture_lets_them_pass():
    check_early(with_rest(mcp_flex=-10), geometry_of((42.0, 60.0, 30.0, 16.0, 100.0, 0.0)))
    with pytest.raises(MakeError):
        check_early(with_rest(mcp_flex=60), geometry_of(CENTRE))


def test_a_thick_skin_leaves_no_bone():
    with pytest.raises(MakeError, match="finger"):
        check_early(with_print(skin_thickness_mm=6.0), geometry_of(CENTRE))
