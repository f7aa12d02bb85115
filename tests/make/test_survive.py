"""A hand with errors follows its path: what settles, what holds, what is told."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fpcad.make.carried import registered
from fpcad.make.grip import ContactLink, Grip
from fpcad.make.survive import _kept, _range_deg, _Trial, survival
from fpcad.wield.evaluate import evaluate

STATES = np.deg2rad(np.arange(-40.0, 61.0, 2.0))


@pytest.fixture(scope="module")
def traced(bench, first_hand):
    return evaluate(bench, first_hand.design, first_hand.states)


def trial(bench, first_hand, path):
    return _Trial(bench, path, first_hand.design, 0.0)


def test_kept_states_have_pose_and_ends_and_small_steps():
    kept = STATES[_kept(STATES)]
    assert kept[0] == STATES[0] and kept[-1] == STATES[-1] and np.abs(kept).min() < 1e-12
    assert np.rad2deg(np.diff(kept)).max() < 12


@pytest.mark.parametrize(
    ("lost", "degrees"), [((), 100), ((0,), 98), ((10, 40), 56), ((20,), 0), ((19, 21), 0)]
)
def test_the_range_ends_at_the_first_state_that_does_not_hold(lost, degrees):
    held = np.ones(len(STATES), dtype=bool)
    held[list(lost)] = False
    assert _range_deg(STATES, held) == pytest.approx(degrees)


def test_gaps_are_those_of_the_exported_trajectories(bench, first_hand, traced):
    path = next(iter(traced.paths.values()))
    tried = trial(bench, first_hand, path)
    joints = path.joints_rad.reshape(len(path.tool_angle_rad), -1)
    pose = bench.spec.poses[path.pose]
    contacts = tuple(ContactLink(c.finger, c.link) for c in pose.contacts)
    grip = Grip(tried.geometry, bench.spec.tool, pose.turning, path.hand_in_tool, contacts)
    hands = np.tile(path.hand_in_tool, (len(joints), 1))
    expected = grip.gaps(joints, path.tool_angle_rad)
    assert tried.gaps(hands, joints, path.tool_angle_rad) == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("number", range(3))
def test_the_tool_is_carried_along_by_a_wrong_hand(bench, first_hand, traced, number):
    path = list(traced.paths.values())[number]
    tried = trial(bench, first_hand, path)
    angles, touched = path.tool_angle_rad, path.contacts
    right = path.joints_rad.reshape(len(angles), -1)
    hands = np.tile(path.hand_in_tool, (len(right), 1))
    wrong = right + np.random.default_rng(3).uniform(-0.03, 0.03, right.shape[1])
    before = np.abs(tried.gaps(hands, wrong, angles)).max(axis=1)
    carried = tried.carried(hands, wrong, right, angles, touched)
    after = np.abs(tried.gaps(carried, wrong, angles)).max(axis=1)
    assert after.mean() < before.mean()
    unmoved = tried.carried(hands, right, right, angles, touched)
    assert np.abs(tried.gaps(unmoved, right, angles)).max() < 1e-5


def test_a_hand_that_moves_as_one_carries_its_tool_with_it():
    rng = np.random.default_rng(4)
    points = rng.normal(size=(5, 4, 3))
    turn, shift = Rotation.from_rotvec([0.3, -0.2, 0.1]).as_matrix(), np.array([1.0, 2.0, -3.0])
    R, p = registered(points, points @ turn.T + shift)
    assert pytest.approx(np.broadcast_to(turn, (5, 3, 3))) == R
    assert p == pytest.approx(np.broadcast_to(shift, (5, 3)))


def test_a_hand_without_errors_keeps_its_range(bench, first_hand, traced):
    told = survival(bench, first_hand.design, traced.paths.values(), draws=3)
    assert set(told) == set(bench.spec.poses)
    for pose, figures in told.items():
        assert figures["tmr_deg"] == pytest.approx(traced.metrics[pose].tmr_deg, abs=0.1)
        assert 0 <= figures["tmr_p5_deg"] <= figures["tmr_median_deg"] <= figures["tmr_deg"] + 0.1
        assert figures["contact_error_max_mm"] > 0.1


def test_equal_seeds_give_equal_figures(bench, first_hand, traced):
    path = next(iter(traced.paths.values()))
    first, second = (survival(bench, first_hand.design, [path], draws=2) for _ in range(2))
    assert first == second
