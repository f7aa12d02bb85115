"""Metrics of paths that are made by hand."""

from __future__ import annotations

import numpy as np
import pytest

from fpcad.model.pose import StateLayout
from fpcad.wield.metrics import PathMetrics, path_metrics, percentile_over
from fpcad.wield.path import WieldingPath, join_traces
from fpcad.wield.rates import End
from fpcad.wield.trace import PathState, Trace

LAYOUT = StateLayout(n_fingers=4, n_joints=3, n_contacts=2)
HAND = np.arange(6.0)
STEP = 0.02


def made(
    direction: float, *states: tuple[float, float, float, float], end: End = End.STATICS
) -> Trace:
    """A trace of (turn, torque, tip force, sliding); a state's entries are all its turn."""
    return Trace(
        [
            PathState(direction * turn, np.full(20, direction * turn), torque, force, slid)
            for turn, torque, force, slid in states
        ],
        end,
    )


MINUS = made(-1.0, (0.0, 300.0, 2.0, 0.0), (0.02, 400.0, 1.5, 0.01), (0.03, 900.0, 1.2, 0.02))
PLUS = made(1.0, (0.0, 500.0, 1.8, 0.0), (0.02, 200.0, 2.5, 0.03), end=End.RATES)


def joined(minus: Trace = MINUS, plus: Trace = PLUS) -> WieldingPath:
    return join_traces("grip", LAYOUT, HAND, minus, plus)


def measured(minus: Trace = MINUS, plus: Trace = PLUS) -> PathMetrics:
    return path_metrics(joined(minus, plus), minus, plus, STEP)


def test_a_path_runs_from_its_minus_end_to_its_plus_end():
    path = joined()
    assert path.tool_angle_rad.tolist() == [-0.03, -0.02, 0.0, 0.02]
    assert path.joints_rad.shape == (4, 4, 3) and path.contacts.shape == (4, 2, 4)
    assert (path.joints_rad[0] == -0.03).all() and (path.contacts[3] == 0.02).all()
    assert (path.end_minus, path.end_plus) == ("statics", "limits")
    assert np.array_equal(path.hand_in_tool, HAND)


def test_the_pose_must_hold_against_both_directions():
    """There the larger torque and the smaller tip force count."""
    path = joined()
    assert path.torque_nmm.tolist() == [900, 400, 500, 200]
    assert path.tip_force_n.tolist() == [1.2, 1.5, 1.8, 2.5]


def test_range_adds_both_directions():
    assert measured().tmr_deg == pytest.approx(np.degrees(0.05))


def test_sliding_is_a_mean_over_contacts_and_time():
    """0.06 mm over two contacts in 0.05 s at 1 rad/s."""
    assert measured().mss_mm_s == pytest.approx(0.06 / (2 * 0.05))


def test_torque_and_tip_force_are_the_worst_along_the_path():
    assert measured().mft_nmm == 900
    assert measured().tip_force_n == 1.2


def test_ends_are_told():
    assert (measured().end_minus, measured().end_plus) == ("statics", "limits")


def test_less_than_a_full_step_either_way_is_no_path():
    short = [made(way, (0.0, 300.0, 2.0, 0.0), (0.019, 400.0, 1.5, 0.01)) for way in (-1.0, 1.0)]
    metrics = measured(*short)
    assert metrics.tmr_deg == 0 and np.isnan(metrics.mss_mm_s)
    assert metrics.mft_nmm == 400


def test_one_full_step_is_a_path():
    minus = made(-1.0, (0.0, 300.0, 2.0, 0.0))
    plus = made(1.0, (0.0, 300.0, 2.0, 0.0), (STEP, 400.0, 1.5, 0.01))
    assert measured(minus, plus).tmr_deg == pytest.approx(np.degrees(STEP))


def test_a_pose_that_is_not_held_has_no_range_and_no_force():
    nothing = [made(way, (0.0, np.inf, 0.0, 0.0)) for way in (-1.0, 1.0)]
    metrics = measured(*nothing)
    assert metrics.tmr_deg == 0 and np.isnan(metrics.mss_mm_s)
    assert metrics.mft_nmm == metrics.mft_p90_nmm == np.inf
    assert metrics.tip_force_n == 0


class TestPercentile:
    def test_of_even_samples_is_the_order_statistic(self):
        axis, values = (
            np.linspace(0, 1, 1001),
            np.random.default_rng(0).permutation(1001.0 * np.linspace(0, 1, 1001)),
        )
        assert percentile_over(axis, values, 0.9) == pytest.approx(0.9 * 1001, rel=2e-3)

    def test_does_not_depend_on_how_densely_a_stretch_is_sampled(self):
        """A tenth of the axis at 5, the rest at 1: dense samples there do not make it more."""
        dense = np.concatenate([np.linspace(0, 0.89, 10), np.linspace(0.9001, 1, 1000)])
        values = np.where(dense < 0.9, 1.0, 5.0)
        assert percentile_over(dense, values, 0.85) == 1
        assert percentile_over(dense, values, 0.95) == 5

    def test_of_a_constant_is_the_constant(self):
        assert percentile_over(np.array([0.0, 1, 3]), np.full(3, 7.0), 0.9) == 7

    @pytest.mark.parametrize("fraction", [0.0, 0.5, 0.9, 1.0])
    def test_is_one_of_the_values(self, fraction: float):
        axis, values = np.array([0.0, 0.3, 0.35, 2.0]), np.array([4.0, 1, 3, 2])
        assert percentile_over(axis, values, fraction) in values

    def test_of_everything_is_the_largest(self):
        assert percentile_over(np.array([0.0, 0.3, 0.35, 2.0]), np.array([4.0, 1, 3, 2]), 1.0) == 4

    def test_of_one_sample_is_that_sample(self):
        assert percentile_over(np.array([0.5]), np.array([42.0]), 0.9) == 42

    @pytest.mark.parametrize("seed", range(5))
    def test_grows_with_the_fraction(self, seed: int):
        random = np.random.default_rng(seed)
        axis, values = np.sort(random.uniform(size=30)), random.normal(size=30)
        found = [percentile_over(axis, values, f) for f in np.linspace(0, 1, 21)]
        assert found == sorted(found)
