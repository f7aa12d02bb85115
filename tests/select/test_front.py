from __future__ import annotations

import numpy as np
import pytest

from fpcad.select.front import pareto_front


def brute_force_front(scores, makeable):
    """A hand is on the front unless a makeable one is as good everywhere and better somewhere."""
    front = []
    for own, takes_part in zip(scores, makeable, strict=True):
        rivals = scores[makeable]
        beaten = ((rivals >= own).all(axis=1) & (rivals > own).any(axis=1)).any()
        front.append(bool(takes_part and not beaten))
    return front


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("levels", [3, 1000])
def test_front_equals_brute_force_with_ties_and_duplicates(seed, levels):
    rng = np.random.default_rng(seed)
    n, m = int(rng.integers(1, 60)), int(rng.integers(1, 10))
    scores = rng.integers(0, levels, (n, m)).astype(float)
    scores = np.vstack([scores, scores[rng.integers(0, n, n // 3)]])
    makeable = rng.random(len(scores)) < 0.7
    assert pareto_front(scores, makeable).tolist() == brute_force_front(scores, makeable)


def test_duplicates_are_on_the_front_together():
    scores = np.array([[1.0, 2.0], [1.0, 2.0], [0.0, 2.0]])
    assert pareto_front(scores, np.ones(3, dtype=bool)).tolist() == [True, True, False]


def test_a_hand_that_cannot_be_made_keeps_no_hand_off_the_front():
    scores = np.array([[9.0, 9.0], [1.0, 1.0]])
    assert pareto_front(scores, np.array([False, True])).tolist() == [False, True]


def test_no_hand_can_be_made():
    assert pareto_front(np.ones((3, 2)), np.zeros(3, dtype=bool)).tolist() == [False] * 3


def test_no_hand_at_all():
    assert pareto_front(np.zeros((0, 9)), np.zeros(0, dtype=bool)).tolist() == []


def test_scores_that_are_not_finite_are_refused():
    with pytest.raises(ValueError, match="finite"):
        pareto_front(np.array([[np.nan]]), np.array([True]))
