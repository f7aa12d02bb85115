"""Twenty hands of clay's box, some corners among them: each is made or refused with a reason, none crashes."""

from __future__ import annotations

from itertools import islice
from pathlib import Path

import pytest

from benchmarks.parts.__main__ import report
from benchmarks.parts.candidates import Outcome, attempt, designs, kind_of
from fpcad.model.hand import hand_template
from fpcad.sample.space import design_space
from fpcad.spec.load import load_spec

CLAY = load_spec(Path(__file__).parents[2] / "designs" / "clay.yaml")
CORNERS = list(islice(designs(CLAY, 64, 1, corners=True), 0, 40, 10))
LEFT_OUT = ("reach", "joints")  # half of the time; the script for 200 hands runs the joints too
RANDOM = list(designs(CLAY, 16, 2, corners=False))


def outcome(verdict: str, reason: str = "", seconds: float = 1.0) -> Outcome:
    return Outcome((1.0,) * 6, verdict, reason, 0, seconds)


@pytest.mark.parametrize("named", [*CORNERS, *RANDOM], ids=range(20))
def test_a_hand_is_made_or_refused_with_a_reason(named):
    found = attempt(CLAY, named, LEFT_OUT)
    assert found.verdict in {"made", "refused", "refused early"}, found
    assert bool(found.reason) == (found.verdict != "made"), found


def test_designs_are_possible_ones_and_the_same_again():
    space, template = design_space(CLAY.hand), hand_template(CLAY.hand)
    assert all(template.feasible(space.internal(named)) for named in [*CORNERS, *RANDOM])
    assert [d.tolist() for d in designs(CLAY, 16, 2, corners=False)] == [d.tolist() for d in RANDOM]


def test_like_reasons_are_counted_together():
    first, second = ("bearing MR63 needs 13.9 mm at (1.0, 2.0, 3.0) mm", "bearing MR63 needs 14 mm")
    assert kind_of(first) == kind_of(second)


def test_the_table_tells_shares_reasons_and_seconds():
    text = report([outcome("made", "", 2.0), outcome("refused", "wall of 0.5 mm")] * 2, "clay", 1)
    assert "| made | 2 | 50.0 % |" in text and "| wall of # mm | 2 |" in text
    assert "median 2.0" in text
