from __future__ import annotations

import numpy as np
import pytest

from fpcad.look.analysis import (
    cluster_table,
    front_hypervolume,
    hypervolume,
    permutation_importance,
    rank_correlation,
    sensitivity,
)
from fpcad.look.groups import NO_CLUSTER, clusters, flat_map, representatives
from fpcad.look.run import Run


def counted_volume(points: np.ndarray, levels: int) -> float:
    """Share of the unit grid's cells below at least one point, counted one by one."""
    m = points.shape[1]
    cells = np.stack(np.meshgrid(*[np.arange(levels)] * m), axis=-1).reshape(-1, m)
    upper = (cells + 1) / levels
    below = np.any((upper[:, None, :] <= points[None] + 1e-12).all(axis=2), axis=1)
    return float(below.mean())


@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("objectives", [1, 2, 3, 4])
def test_hypervolume_counts_cells_with_ties_and_duplicates(seed, objectives):
    rng = np.random.default_rng(seed)
    levels = 6
    points = rng.integers(0, levels + 1, (int(rng.integers(1, 25)), objectives)) / levels
    points = np.vstack([points, points[:3]])
    found = hypervolume(points)
    assert found.exact
    assert found.value == pytest.approx(counted_volume(points, levels))


def test_an_empty_front_dominates_nothing():
    assert hypervolume(np.zeros((0, 9))).value == 0.0


def test_the_best_hand_of_all_dominates_everything():
    assert hypervolume(np.ones((1, 9))).value == pytest.approx(1.0)


def test_many_scores_of_many_hands_are_approximated_closely():
    points = np.random.default_rng(1).uniform(0, 1, (70, 6))
    found, exact = hypervolume(points), hypervolume(points[:0])
    assert not found.exact
    assert exact.exact
    from moocore import hypervolume as slow

    assert found.value == pytest.approx(slow(points, ref=np.zeros(6), maximise=True), rel=0.01)


def test_rank_correlation_sees_order_and_nothing_else():
    x = np.arange(10.0)
    assert rank_correlation(x, np.exp(x)) == pytest.approx(1.0)
    assert rank_correlation(x, -(x**3)) == pytest.approx(-1.0)
    assert np.isnan(rank_correlation(x, np.ones(10)))
    assert np.isnan(rank_correlation(x[:2], x[:2]))


def test_importance_finds_the_parameter_that_matters():
    x = np.random.default_rng(0).uniform(-0.5, 0.5, (200, 3))
    importance, fit = permutation_importance(x, np.sin(5 * x[:, 1]))
    assert np.argmax(importance) == 1
    assert importance[1] > 10 * max(importance[0], importance[2])
    assert fit > 0.9


def test_importance_needs_hands_and_a_metric_that_varies():
    x = np.random.default_rng(0).uniform(-0.5, 0.5, (30, 2))
    assert np.isnan(permutation_importance(x[:5], x[:5, 0])[0]).all()
    assert np.isnan(permutation_importance(x, np.ones(30))[0]).all()


def test_sensitivity_has_a_row_for_each_metric_and_parameter(made_up: Run):
    told = sensitivity(made_up)
    assert told.num_rows == len(made_up.metric_columns) * int(made_up.space.free.sum())
    assert (np.abs(told["rank_correlation"].to_numpy()) <= 1).all()


def test_hypervolume_of_a_run_is_a_share(made_up: Run):
    assert 0 < front_hypervolume(made_up).value < 1


def test_clusters_are_found_and_counted_by_size():
    rng = np.random.default_rng(0)
    centres = np.repeat([[-0.4, -0.4], [0.4, 0.4]], [40, 20], axis=0)
    labels = clusters(centres + rng.normal(0, 0.02, (60, 2)))
    assert set(labels[:40]) <= {0, NO_CLUSTER}
    assert set(labels[40:]) <= {1, NO_CLUSTER}
    assert (labels != NO_CLUSTER).sum() > 50


@pytest.mark.parametrize("n", [0, 1, 5])
def test_a_few_hands_are_no_cluster(n):
    assert clusters(np.zeros((n, 6))).tolist() == [NO_CLUSTER] * n


def test_a_representative_is_the_best_of_its_cluster_and_on_the_front_if_any_is():
    labels, merit = np.array([0, 0, 0, 1, 1, -1]), np.array([1.0, 3.0, 2.0, np.nan, 4.0, 9.0])
    nobody = np.zeros(6, dtype=bool)
    assert representatives(labels, merit, nobody).tolist() == [1, 4]
    front = np.array([False, False, True, False, False, False])
    assert representatives(labels, merit, front).tolist() == [2, 4]


def test_two_free_parameters_are_their_own_map():
    named = np.array([[50.0, 20.0], [120.0, 40.0]])
    drawn = flat_map(np.array([[-0.5, -0.5], [0.5, 0.5]]), ("d2", "d3"), named)
    assert drawn.points.tolist() == named.tolist()
    assert drawn.axes == ("d2", "d3")


@pytest.mark.parametrize("free", [0, 1, 6])
@pytest.mark.parametrize("n", [0, 1, 3])
def test_any_number_of_hands_and_parameters_has_a_map(free, n):
    points = np.random.default_rng(0).uniform(-0.5, 0.5, (n, free))
    names = tuple(f"d{k}" for k in range(free))
    assert flat_map(points, names, points).points.shape == (n, 2)


def test_t_sne_tells_its_perplexity_and_seed_and_repeats_itself():
    points = np.random.default_rng(0).uniform(-0.5, 0.5, (40, 6))
    first, second = (flat_map(points, tuple("abcdef"), points) for _ in range(2))
    assert "perplexity 13" in first.told
    assert "seed 0" in first.told
    assert first.points.tolist() == second.points.tolist()


def test_every_hand_of_a_run_has_a_cluster_or_none(made_up: Run):
    assert cluster_table(made_up)["id"].to_pylist() == made_up.ids.tolist()
