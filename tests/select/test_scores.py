from __future__ import annotations

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from fpcad.errors import StoreError
from fpcad.select.ranking import rank_table
from fpcad.select.scores import score, score_table, scored_metrics
from fpcad.spec.process import Resolutions, Selection
from tests.select.tables import POSES, metrics_table, random_metrics

NAN = float("nan")


@pytest.mark.parametrize(
    ("values", "better", "expected"),
    [
        ([10.0, 20.0, 30.0], "larger", [0, 50, 100]),
        ([10.0, 20.0, 30.0], "smaller", [100, 50, 0]),
        ([-5.0, 15.0, 0.0], "larger", [0, 100, 25]),
        ([7.0, 7.0, 7.0], "larger", [100, 100, 100]),
        ([7.0], "smaller", [100]),
        ([10.0, NAN, 30.0], "larger", [0, 0, 100]),
        ([10.0, NAN, 30.0], "smaller", [100, 0, 0]),
        ([NAN, 4.0], "larger", [0, 100]),
        ([NAN, NAN], "smaller", [0, 0]),
        ([], "larger", []),
    ],
)
def test_scores_run_linearly_from_worst_to_best(values, better, expected):
    assert score(np.array(values), better, 0.1) == pytest.approx(expected)


def test_values_within_one_resolution_are_equal():
    values = np.array([50.01, 50.02, 49.98])
    assert score(values, "larger", 0.1).tolist() == [100, 100, 100]


def test_no_score_is_negative_zero():
    for better in ("larger", "smaller"):
        assert not np.signbit(score(np.array([1.0, 2.0, 3.0]), better, 0.1)).any()


@given(
    steps=arrays(np.int64, st.integers(1, 30), elements=st.integers(-1000, 1000)),
    resolution=st.sampled_from([1e-3, 0.1, 1.0]),
    seed=st.integers(0, 2**32 - 1),
)
def test_noise_below_half_the_resolution_changes_no_score(steps, resolution, seed):
    values = steps * resolution
    noise = np.random.default_rng(seed).uniform(-0.49, 0.49, len(steps)) * resolution
    for better in ("larger", "smaller"):
        clean, noisy = score(values, better, resolution), score(values + noise, better, resolution)
        assert clean.tolist() == noisy.tolist()


@given(values=arrays(np.float64, st.integers(2, 30), elements=st.floats(-1e4, 1e4)))
def test_scores_keep_the_order_of_values_that_differ(values):
    scores = score(values, "larger", 0.1)
    better = values[:, None] > values[None, :] + 0.1
    assert (scores[:, None] > scores[None, :])[better].all()
    assert ((scores >= 0) & (scores <= 100)).all()


def test_an_infinite_metric_is_refused():
    with pytest.raises(ValueError, match="finite"):
        score(np.array([1.0, np.inf]), "larger", 0.1)


def test_a_table_gains_three_scores_a_pose_and_their_mean():
    table = metrics_table(
        3,
        carve_tmr_deg=[10.0, 30.0, 20.0],
        carve_mss_mm_s=[0.0, 0.0, 1.0],
        carve_mft_p90_nmm=[500.0, 900.0, 700.0],
    )
    scored = score_table(table, POSES, Selection()).to_pydict()
    assert scored["carve_tmr_score"] == [0, 100, 50]
    assert scored["carve_mss_score"] == [100, 100, 0]
    assert scored["carve_torque_score"] == [100, 0, 50]
    for metric in ("tmr", "mss", "torque"):
        assert scored[f"poke_{metric}_score"] == [100, 100, 100]
    assert scored["mean_score"] == pytest.approx([500 / 6, 500 / 6, 400 / 6])


def test_a_pose_without_a_path_scores_zero_in_all_its_metrics():
    table = metrics_table(
        3, carve_tmr_deg=[0.0, 30.0, 60.0], carve_mss_mm_s=[0.0, 0.5, 1.0], carve_mft_nmm=[0, 1, 2]
    )
    scored = score_table(table, POSES, Selection(torque="mft")).to_pydict()
    assert scored["carve_tmr_score"] == [0, 0, 100]
    assert scored["carve_mss_score"] == [0, 100, 0]  # its 0 mm/s is no path's, and sets no best
    assert scored["carve_torque_score"] == [0, 100, 0]
    assert scored["poke_tmr_score"] == [100, 100, 100]


@pytest.mark.parametrize("missing", [NAN, None])
def test_a_missing_metric_scores_zero(missing):
    table = metrics_table(2, carve_mss_mm_s=pa.array([missing, 1.0], pa.float64()))
    assert score_table(table, POSES, Selection())["carve_mss_score"].to_pylist() == [0, 100]


def test_the_torque_that_the_spec_names_is_scored():
    table = metrics_table(2, carve_mft_nmm=[1000.0, 2000.0], carve_mft_p90_nmm=[900.0, 100.0])
    by = {
        torque: score_table(table, POSES, Selection(torque=torque))[
            "carve_torque_score"
        ].to_pylist()
        for torque in ("mft", "mft_p90")
    }
    assert by == {"mft": [100, 0], "mft_p90": [0, 100]}


def test_resolutions_come_from_the_spec():
    coarse = Selection(resolutions=Resolutions(tmr_deg=10, mss_mm_s=1, mft_nmm=1000))
    assert [metric.resolution for metric in scored_metrics(coarse)] == [10, 1, 1000]
    table = metrics_table(2, carve_tmr_deg=[51.0, 54.0])
    assert score_table(table, POSES, coarse)["carve_tmr_score"].to_pylist() == [100, 100]


def test_a_missing_column_is_named():
    with pytest.raises(StoreError, match="no column `poke_mss_mm_s`"):
        score_table(metrics_table(2).drop_columns("poke_mss_mm_s"), POSES, Selection())


def test_ranking_a_ranked_table_again_changes_nothing():
    once = rank_table(random_metrics(40, seed=1), POSES, Selection())
    assert rank_table(once, POSES, Selection()).equals(once)


def test_ranking_with_another_torque_replaces_the_scores():
    metrics = random_metrics(40, seed=2)
    twice = rank_table(rank_table(metrics, POSES, Selection()), POSES, Selection(torque="mft"))
    assert twice.equals(rank_table(metrics, POSES, Selection(torque="mft")))
