"""Gaps in numbers against the symbolic model, and segment distances against brute force."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from fpcad.make.grip import ContactLink, Grip, link_axis, segment_distance
from fpcad.model.frames import rot_axis, rot_rpy
from fpcad.model.geometry import link_poses
from fpcad.model.hand import hand_template
from fpcad.spec.pose import Turning
from fpcad.units import to_internal
from tests.make.mechanism import mechanism


@pytest.mark.parametrize("link", ["proximal", "distal"])
@pytest.mark.parametrize("finger", ["thumb", "index", "middle", "ring"])
def test_link_axes_are_those_of_the_symbolic_model(finger: str, link: str):
    hand = mechanism("carve")
    template = hand_template(hand.spec.hand)
    assert hand.spec.initial is not None
    design = to_internal(template.names.parameters, hand.spec.initial.design)
    joints = np.random.default_rng(1).uniform(hand.limits[0], hand.limits[1], (5, 12))
    start, end = link_axis(hand.geometry, ContactLink(finger, link), joints)
    geometry = hand.geometry
    length = {
        "proximal": geometry.proximal_length_mm,
        "distal": geometry.distal_length_mm - geometry.radius_mm,
    }[link]
    for k, u in enumerate(joints):
        T_palm_link = link_poses(template, design, u.reshape(4, 3))[finger][link]
        np.testing.assert_allclose(start[k], T_palm_link[:3, 3], atol=1e-12)
        np.testing.assert_allclose(end[k], (T_palm_link @ [length, 0, 0, 1])[:3], atol=1e-12)


def test_tool_turns_about_any_axis_through_any_pivot():
    hand = mechanism("carve")
    turning = Turning(axis=(1.0, -2.0, 0.5), pivot_mm=(3.0, 20.0, -7.0))
    grip = Grip(hand.geometry, hand.spec.tool, turning, hand.hand_in_tool, ())
    origin, orientation = grip.tool_poses(np.array([0.7]))
    R_tool_palm = np.array(ca.DM(rot_rpy(*hand.hand_in_tool[3:])))
    turn = np.array(ca.DM(rot_axis(turning.axis, 0.7)))
    pivot = np.array(turning.pivot_mm)
    for point in np.eye(3) * 40:
        turned = pivot + turn @ (point - pivot)
        expected = R_tool_palm.T @ (turned - hand.hand_in_tool[:3])
        np.testing.assert_allclose(origin[0] + orientation[0].apply(point), expected, atol=1e-12)


def test_known_poses_have_no_gap():
    for pose in ("carve", "poke", "press"):
        hand = mechanism(pose)
        assert hand.spec.initial is not None
        given = hand.spec.initial.poses[pose].joints_deg
        joints = np.radians(np.concatenate([given[f] for f in hand.geometry.fingers]))
        gaps = hand.grip.gaps(joints[None], np.zeros(1))
        assert np.abs(gaps).max() < 1e-5, pose  # the file rounds to 1e-6 deg


def test_segment_distance_is_that_of_brute_force():
    random = np.random.default_rng(2)
    a, b, c, d = random.normal(size=(4, 60, 3))
    share = np.linspace(0.0, 1.0, 201)[:, None, None]
    on_first, on_second = a + share * (b - a), c + share * (d - c)
    distances = np.linalg.norm(on_first[:, None] - on_second[None], axis=3).min(axis=(0, 1))
    exact = segment_distance(a, b, c, d)
    assert np.all(exact <= distances + 1e-12)
    np.testing.assert_allclose(exact, distances, atol=2e-2)


@pytest.mark.parametrize(
    ("second", "distance"),
    [
        ([[0, 1, 0], [2, 1, 0]], 1.0),  # parallel, side by side
        ([[5, 0, 0], [7, 0, 0]], 3.0),  # on one line, apart
        ([[1, 0, 0], [7, 0, 0]], 0.0),  # on one line, overlapping
        ([[1, -1, 2], [1, 1, 2]], 2.0),  # crossing over
        ([[3, 1, 0], [3, 5, 0]], np.sqrt(2)),  # end to end
        ([[0, 1, 0], [2, 1, 1e-9]], 1.0),  # all but parallel
    ],
)
def test_segment_distance_in_special_positions(second, distance):
    start, end = np.array([[0.0, 0, 0]]), np.array([[2.0, 0, 0]])
    c, d = (np.array([point], dtype=float) for point in second)
    assert segment_distance(start, end, c, d)[0] == pytest.approx(distance, abs=1e-9)
    assert segment_distance(c, d, start, end)[0] == pytest.approx(distance, abs=1e-9)


def test_clearance_is_asked_of_all_that_may_not_touch():
    hand = mechanism("carve")
    joints, still = hand.posture[None], np.zeros(1)
    clearances = hand.grip.clearances(joints, still)
    assert clearances.shape == (1, 8 - 3 + len(hand.geometry.palm))
    assert clearances.min() > 0 and hand.grip.errors(joints, still) < 1e-9
    straightened = joints.copy()
    straightened[0, 9:] = np.radians([20, 6, 0])  # the free ring finger, where the tool will be
    reached = [float(hand.grip.clearances(straightened, np.array([a])).min()) for a in (-0.4, 0.4)]
    assert reached[0] > 0 > -1 > reached[1]
