import math

import numpy as np
import pytest

from benchmarks.paper.document_control import group_rows, whole_hands
from benchmarks.paper.markdown import confidence, interval, share, table
from benchmarks.paper.packing import ball_share, fill_box, least_distance, window_stop
from benchmarks.paper.published import FULL, PLANE
from fpcad.spec.process import Sampling


def test_a_table_has_a_rule_and_all_rows():
    assert table(("a", "b"), [(1, 2)]) == "| a | b |\n| --- | ---: |\n| 1 | 2 |"


def test_shares_tell_their_counts():
    assert share(1, 4) == "25.00% (1 of 4)"
    assert share(0, 0) == "none"


def test_intervals_agree_with_the_closed_form_where_nothing_fails():
    # Clopper-Pearson for n successes of n: the lower bound solves p^n = 0.025.
    assert confidence(20, 20) == pytest.approx((0.025 ** (1 / 20), 1.0))
    assert interval(0, 0) == "-"


@pytest.mark.parametrize(("paper", "dimensions"), [(PLANE, 2), (FULL, 6)])
def test_the_papers_volumes_follow_from_a_distance_of_one_thirtieth(paper, dimensions):
    points = np.zeros((paper.candidates, dimensions))
    assert ball_share(points, 1 / 30) == pytest.approx(paper.occupied, rel=5e-3)


def test_the_volume_of_one_ball():
    assert ball_share(np.zeros((1, 3)), 1.0) == pytest.approx(math.pi / 6)


def test_the_least_distance_is_that_of_the_nearest_pair():
    assert least_distance(np.array([[0, 0], [3, 4], [0, 1.0]])) == 1.0


def test_a_window_ends_a_run_at_the_first_call_below_the_least_efficiency():
    settings = Sampling(efficiency_window=4, min_efficiency=0.3)
    accepted = np.array([1, 1, 1, 0, 0, 0, 1, 1], dtype=bool)
    assert window_stop(accepted, settings) == 6
    assert window_stop(accepted[:5], settings) == 5


def test_a_free_box_fills_to_its_stop_and_on():
    settings = Sampling(min_distance=0.2, step=0.25, efficiency_window=50, min_efficiency=0.05)
    filling = fill_box(settings, 600)
    assert 10 < filling.window_candidates <= filling.total_candidates < 40
    assert filling.window_calls < 600


def examined(hand, pose, held, on, off):
    return {
        "hand": hand, "pose": pose, "held": held, "moved": 0.0, "cost": 1.0,
        "tmr_on_deg": on, "tmr_off_deg": off,
    }  # fmt: skip


def test_a_hand_is_as_good_as_its_worst_pose():
    rows = [examined(3, "a", 2, 20.0, 90.0), examined(3, "b", 1, 5.0, 100.0)]
    assert whole_hands(rows) == [
        {"held": 1, "moved": 0.0, "cost": 2.0, "tmr_on_deg": 5.0, "tmr_off_deg": 90.0}
    ]


def test_poses_of_a_group_are_counted_by_how_they_are_held():
    rows = [examined(n, "a", 2 * (n > 0), 20.0 * n, 90.0) for n in range(4)]
    found = list(group_rows("g", rows))
    assert [line[:4] for line in found] == [
        ("g", "both ways", "a", "3"),
        ("g", "both ways", "all", "3"),
        ("g", "not", "a", "1"),
        ("g", "not", "all", "1"),
    ]
    assert found[0][6].startswith("100.0 [") and found[2][6].startswith("0.0 [")
