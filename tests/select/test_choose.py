from __future__ import annotations

import typing

import numpy as np
import pyarrow as pa
import pytest

from fpcad.errors import SolveError
from fpcad.select.choose import RULES, choose, finalists
from fpcad.select.ranking import rank_table
from fpcad.spec.process import Selection
from tests.select.tables import POSES, metrics_table, random_metrics


def ranked(scores, **columns):
    """A ranked table of two scores a hand, with the front left to the test."""
    scores = np.array(scores, dtype=float)
    n = len(scores)
    values = {
        "id": np.arange(n),
        "makeable": [True] * n,
        "reason": [""] * n,
        "carve_tmr_score": scores[:, 0],
        "poke_tmr_score": scores[:, 1],
        "mean_score": scores.mean(axis=1),
        "pareto": [True] * n,
    }
    return pa.table(values | columns)


BY_HAND = [[100, 0], [60, 50], [40, 45], [90, 19]]  # means 50, 55, 42.5, 54.5


@pytest.mark.parametrize(
    ("rule", "front", "chosen"),
    [
        ("best_mean_on_front", [True, True, False, True], 1),
        ("best_mean_on_front", [True, False, False, True], 3),
        ("best_mean", [True, False, False, True], 1),
        ("best_worst_score", [True, False, False, True], 1),
    ],
)
def test_rules_by_hand(rule, front, chosen):
    assert choose(ranked(BY_HAND, pareto=front), rule).id == chosen


def test_best_worst_score_prefers_the_even_hand():
    table = ranked([[100, 30], [40, 35]])
    assert choose(table, "best_worst_score").id == 1
    assert choose(table, "best_mean").id == 0


def test_every_rule_of_the_spec_exists_and_no_other():
    rules = typing.get_args(Selection.model_fields["rule"].annotation)
    assert set(rules) == set(RULES)


@pytest.mark.parametrize("rule", RULES)
def test_equal_hands_go_to_the_lowest_id(rule):
    assert choose(ranked([[50, 50]] * 4, id=[7, 9, 3, 5]), rule).id == 3


def test_means_that_differ_in_their_last_bits_are_equal():
    table = ranked([[50, 50], [50, 50]], mean_score=[50.0, np.nextafter(50.0, 51)])
    assert choose(table, "best_mean").id == 0


@pytest.mark.parametrize("rule", RULES)
def test_what_cannot_be_made_is_never_chosen(rule):
    table = ranked([[100, 100], [10, 10], [90, 90]], makeable=[False, True, None])
    assert choose(table, rule).id == 1


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("seed", range(5))
def test_what_cannot_be_made_is_never_chosen_from_random_tables(rule, seed):
    metrics = random_metrics(40, seed)
    chosen = choose(rank_table(metrics, POSES, Selection()), rule).id
    assert metrics["makeable"][chosen].as_py()


@pytest.mark.parametrize("rule", RULES)
def test_the_order_of_the_rows_does_not_matter(rule):
    table = rank_table(random_metrics(40, seed=3), POSES, Selection())
    shuffled = table.take(np.random.default_rng(0).permutation(40))
    assert choose(shuffled, rule) == choose(table, rule)


@pytest.mark.parametrize("rule", RULES)
def test_noise_below_the_resolutions_changes_no_choice(rule):
    rng = np.random.default_rng(5)
    clean, noisy = {}, {}
    for pose in POSES:
        for name, resolution in (("tmr_deg", 0.1), ("mss_mm_s", 1e-3), ("mft_p90_nmm", 1.0)):
            values = rng.integers(1, 1500, 50) * resolution
            clean[f"{pose}_{name}"] = values
            noisy[f"{pose}_{name}"] = values + rng.uniform(-0.49, 0.49, 50) * resolution
    choices = [
        choose(rank_table(metrics_table(50, **columns), POSES, Selection()), rule)
        for columns in (clean, noisy)
    ]
    assert choices[0] == choices[1]


def test_the_reason_tells_the_numbers():
    table = ranked(BY_HAND, pareto=[True, True, False, False], makeable=[True, True, True, False])
    assert choose(table, "best_mean_on_front").reason == (
        "best mean score (55.0) of 2 hands on the Pareto front; 4 hands in all, 1 refused"
    )
    assert choose(table, "best_worst_score").reason == (
        "best lowest score (50.0) of 3 hands that can be made; 4 hands in all, 1 refused"
    )


def test_a_choice_carries_its_scores():
    assert choose(ranked(BY_HAND), "best_mean").scores == {
        "carve_tmr_score": 60,
        "poke_tmr_score": 50,
        "mean_score": 55,
    }


def test_one_hand_is_chosen_whatever_it_scores():
    table = rank_table(
        metrics_table(1, carve_tmr_deg=[0.0], poke_tmr_deg=[0.0]), POSES, Selection()
    )
    choice = choose(table, "best_mean_on_front")
    assert (choice.id, choice.scores["mean_score"]) == (0, 0)


def test_nothing_to_choose_from_names_the_most_frequent_reason():
    thin = "the IP joint needs 12 mm, the finger has 11.3"
    table = ranked(BY_HAND, makeable=[False] * 4, reason=[thin, "palm too short", thin, None])
    with pytest.raises(SolveError) as error:
        choose(table, "best_mean")
    assert str(error.value) == f"none of 4 hands can be made: {thin} (2 of them)"


def test_an_empty_table_is_told_apart():
    with pytest.raises(SolveError, match="no hand to choose from"):
        choose(ranked(BY_HAND).slice(0, 0), "best_mean")


SHARES = ("carve_held_share", "poke_held_share")


def tried(carve, poke, **columns):
    """BY_HAND with shares of the planned range; None where a hand was not tried."""
    shares = [pa.array(values, pa.float64()) for values in (carve, poke)]
    return ranked(BY_HAND, **dict(zip(SHARES, shares, strict=True)), **columns)


def test_finalists_are_the_best_by_the_rule_that_can_be_made():
    table = ranked(BY_HAND, pareto=[True, True, False, True])
    assert finalists(table, "best_mean_on_front", 2) == [1, 3]
    assert finalists(table, "best_mean_on_front", 9) == [1, 3, 0]
    assert finalists(ranked(BY_HAND, makeable=[True, False, True, True]), "best_mean", 2) == [3, 0]


def test_equal_finalists_come_by_their_ids():
    assert finalists(ranked([[50, 50]] * 4, id=[7, 9, 3, 5]), "best_mean", 2) == [3, 5]


@pytest.mark.parametrize(
    ("carve", "poke", "chosen"),
    [
        ([0.9, 0.9, None, 0.9], [0.2, 0.3, None, 0.4], 3),  # by the worst trial
        ([0.8, 0.7, None, 0.9], [0.4, 0.4, None, 0.4], 3),  # then by the mean
        ([0.8, 0.8, None, 0.8], [0.4, 0.4, None, 0.404], 1),  # a hundredth says nothing: the rule
        ([None, None, 0.1, None], [None, None, 0.0, None], 2),  # tried before all others
        ([None] * 4, [None] * 4, 1),  # nothing tried
        ([0.9, None, None, None], [None] * 4, 1),  # not tried in all poses
    ],
)
def test_physics_comes_before_the_rule(carve, poke, chosen):
    assert choose(tried(carve, poke), "best_mean", SHARES).id == chosen


def test_a_finalist_that_cannot_be_made_is_not_chosen():
    table = tried([0.9, 0.8, None, 0.1], [0.9, 0.8, None, 0.1], makeable=[False, True, True, True])
    assert choose(table, "best_mean", SHARES).id == 1
    none_left = tried([0.9] + 3 * [None], [0.9] + 3 * [None], makeable=[False, True, True, True])
    assert choose(none_left, "best_mean", SHARES).id == 1


def test_the_reason_tells_what_physics_said():
    table = tried([0.9, 0.9, None, None], [0.2, 0.3, None, None])
    assert choose(table, "best_mean", SHARES).reason == (
        "turns the tool farthest in physics, by 30% of the planned range in its worst trial and 60% "
        "in the mean; tried were 2 hands, those with the best mean score that can be made; "
        "4 hands in all, none refused so far"
    )
