"""The curve of contact postures between the states of a path."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fpcad.errors import MakeError
from fpcad.make.refine import CURVE_GAP_MM, Leg, contact_curve, guide_spline, legs
from tests.make.mechanism import Mechanism, mechanism


@pytest.fixture(scope="module")
def kinked() -> Mechanism:
    """A hand whose middle and index fingers run into their abduction limits."""
    return mechanism("carve", mcp_abd=(-5, 6))


def test_a_kink_is_where_the_hand_meets_its_limits(kinked: Mechanism):
    joints = kinked.path(25, 25).joints_rad.reshape(-1, 12)
    at_limit = np.isclose(joints, kinked.limits[0]) | np.isclose(joints, kinked.limits[1])
    assert at_limit[-1].any() and not at_limit[:, 4:8].all(axis=0).any()


@pytest.mark.parametrize("side", [0, 1])
def test_curve_keeps_contact_and_limits_between_states(kinked: Mechanism, side: int):
    leg = legs(kinked.path(25, 25))[side]
    curve = contact_curve(leg, kinked.grip, kinked.project, kinked.limits)
    turns = np.linspace(0.0, curve.length, 2500)
    joints = curve.at(turns)[0]
    assert np.abs(kinked.grip.gaps(joints, leg.direction * turns)).max() < 1.5 * CURVE_GAP_MM
    assert np.all(joints >= kinked.limits[0] - 5e-7) and np.all(joints <= kinked.limits[1] + 5e-7)


def test_curve_starts_and_ends_at_the_paths_own_states(kinked: Mechanism):
    leg = legs(kinked.path(0, 25))[0]
    curve = contact_curve(leg, kinked.grip, kinked.project, kinked.limits)
    np.testing.assert_array_equal(curve.at(np.array([0.0]))[0][0], leg.joints[0])
    np.testing.assert_allclose(curve.at(leg.turn[-1:])[0][0], leg.joints[-1], atol=1e-14)


def test_curve_is_twice_differentiable_across_its_knots(kinked: Mechanism):
    leg = legs(kinked.path(0, 25))[0]
    curve = contact_curve(leg, kinked.grip, kinked.project, kinked.limits)
    inner = curve.joints.x[1:-1]
    for before, after in zip(curve.at(inner - 1e-10), curve.at(inner + 1e-10), strict=True):
        np.testing.assert_allclose(before, after, atol=1e-4 * max(1.0, np.abs(after).max()))


def test_curve_stays_close_to_the_path(kinked: Mechanism):
    leg = legs(kinked.path(0, 25))[0]
    curve = contact_curve(leg, kinked.grip, kinked.project, kinked.limits)
    assert np.abs(curve.at(leg.turn)[0] - leg.joints).max() < np.radians(0.5)


def test_guide_rests_exactly_where_a_joint_rests():
    turn = np.linspace(0.0, 0.4, 24)
    joints = np.minimum(turn[:, None], 0.2)
    guide = guide_spline(Leg(1.0, turn, joints))
    assert np.all(guide(np.linspace(0.23, 0.4, 500)) == pytest.approx(0.2, abs=1e-15))
    assert guide(np.linspace(0.0, 0.4, 500)).max() <= 0.2 + 1e-15


def test_straight_path_is_reproduced_by_the_guide():
    turn = np.array([0.0, 0.0175, 0.035, 0.0525, 0.055])
    guide = guide_spline(Leg(1.0, turn, turn[:, None] * [[2.0, -1.0]]))
    fine = np.linspace(0.0, 0.055, 100)
    np.testing.assert_allclose(guide(fine), fine[:, None] * [[2.0, -1.0]], atol=1e-15)


def test_path_without_a_state_at_the_pose_is_refused(kinked: Mechanism):
    path = kinked.path(1, 1)
    with pytest.raises(ValueError, match="0 states at tool angle 0"):
        legs(replace(path, tool_angle_rad=path.tool_angle_rad + 1e-3))


def test_projection_that_misses_contact_is_reported(kinked: Mechanism):
    leg = legs(kinked.path(0, 5))[0]
    with pytest.raises(MakeError, match="not in contact, or in the tool at a tool angle of"):
        contact_curve(leg, kinked.grip, lambda _, guess: guess + 1e-3, kinked.limits)


def test_posture_with_a_finger_in_the_tool_is_reported(kinked: Mechanism):
    def with_straight_ring(tool_angle, guess):
        joints = kinked.project(tool_angle, guess)
        joints[9:] = np.radians([-4.8, 3.4, 0])
        return joints

    leg = legs(kinked.path(25, 0))[0]
    with pytest.raises(MakeError, match="not in contact, or in the tool at a tool angle of"):
        contact_curve(leg, kinked.grip, with_straight_ring, kinked.limits)


def test_failure_of_the_projection_reaches_the_caller(kinked: Mechanism):
    def fails(tool_angle, guess):
        raise MakeError("no posture here")

    with pytest.raises(MakeError, match="no posture here"):
        contact_curve(legs(kinked.path(0, 5))[0], kinked.grip, fails, kinked.limits)
