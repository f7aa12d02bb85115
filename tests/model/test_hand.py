"""The hand template against plain NumPy, and what it counts as a hand."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from fpcad.model.geometry import hand_geometry, homogeneous, link_poses
from fpcad.model.hand import hand_template
from fpcad.spec.schema import Spec
from tests.model.plain_hand import FINGERS, link_frame, root_frame
from tests.model.postures import random_posture

SEEDS = range(5)
CENTRE = np.array([42.5, 85.0, 30.0, 16.0, np.radians(75), 0.0])


@pytest.mark.parametrize("seed", SEEDS)
def test_links_lie_where_plain_numpy_puts_them(clay: Spec, seed: int):
    at = random_posture(clay, "carve", seed)
    poses = link_poses(hand_template(clay.hand), at.d, at.u)
    for finger, u in zip(FINGERS, at.u, strict=True):
        for link in ("proximal", "distal"):
            plain = link_frame(finger, link, at.d, u)
            assert np.allclose(poses[finger][link][:3, :3], plain.R, atol=1e-13)
            assert np.allclose(poses[finger][link][:3, 3], plain.p, atol=1e-11)


@pytest.mark.parametrize("finger", FINGERS)
def test_roots_lie_where_plain_numpy_puts_them(clay: Spec, finger: str):
    d = random_posture(clay, "carve", 3).d
    frame = homogeneous(hand_template(clay.hand).root_frame(finger, ca.DM(d)))
    plain = root_frame(finger, d)
    assert np.allclose(frame[:3, :3], plain.R) and np.allclose(frame[:3, 3], plain.p)


def test_straight_fingers_are_as_long_as_the_spec_says(clay: Spec):
    template = hand_template(clay.hand)
    poses = link_poses(template, CENTRE, np.zeros((4, 3)))
    geometry = hand_geometry(template, CENTRE)
    for finger in FINGERS:
        apex = poses[finger]["distal"] @ [geometry.distal_length_mm, 0, 0, 1]
        root = geometry.T_palm_root[finger][:3, 3]
        assert np.linalg.norm(apex[:3] - root) == pytest.approx(clay.hand.finger_length_mm)


def test_flexion_curls_towards_the_palm(clay: Spec):
    """The palm's dorsal side is +z of H: flexed fingertips lie lower than straight ones."""
    template = hand_template(clay.hand)
    straight = link_poses(template, CENTRE, np.zeros((4, 3)))
    for joint in (0, 2):
        joints = np.zeros((4, 3))
        joints[:, joint] = 0.3
        flexed = link_poses(template, CENTRE, joints)
        for finger in FINGERS:
            tips = [pose[finger]["distal"] @ [CENTRE[0], 0, 0, 1] for pose in (straight, flexed)]
            root = straight[finger]["proximal"]
            palmar = -root[:3, 2]
            assert (tips[1] - tips[0])[:3] @ palmar > 1.0


def test_thumb_faces_the_fingers(clay: Spec):
    roots = hand_geometry(hand_template(clay.hand), CENTRE).T_palm_root
    assert roots["thumb"][0, 3] == -42.5 and roots["middle"][0, 3] == 42.5
    assert roots["thumb"][:3, 0] == pytest.approx(roots["middle"][:3, 0] * [-1, -1, 1])


@pytest.mark.parametrize(
    ("change", "feasible"),
    [
        ({}, True),
        ({2: 18.0}, True),  # roots d4 + 2 mm apart
        ({2: 17.9}, False),
        ({0: 8.0}, False),  # the distal link is nothing but its cap
        ({0: 8.1}, True),
        ({0: 92.0}, False),  # the proximal link is
        ({0: 91.9}, True),
    ],
)
def test_overlapping_roots_and_links_of_nothing_are_no_hand(
    clay: Spec, change: dict[int, float], feasible: bool
):
    design = CENTRE.copy()
    for place, value in change.items():
        design[place] = value
    assert hand_template(clay.hand).feasible(design) is feasible


def test_palm_follows_the_roots(clay: Spec):
    geometry = hand_geometry(hand_template(clay.hand), CENTRE)
    shapes = {shape.name: shape for shape in geometry.palm}
    assert shapes["spine"].start_mm.tolist() == [-42.5, 0, 9]
    assert shapes["spine"].end_mm.tolist() == [42.5, 0, 9]
    assert shapes["knuckles"].start_mm.tolist() == [42.5, 30, 9]
    assert shapes["knuckles"].end_mm.tolist() == [42.5, -30, 9]
    assert shapes["ring_mcp"].start_mm.tolist() == [42.5, -30, 3]
    assert shapes["ring_mcp"].end_mm.tolist() == [42.5, -30, 3]
    assert shapes["ring_mcp"].finger == "ring" and shapes["spine"].finger is None
