"""Poses that were solved and checked elsewhere touch the tool in this model too."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from fpcad.model.state import pose_state
from fpcad.solve.attempt import Workbench
from fpcad.spec.schema import Spec
from tests.model.plain_hand import FINGERS, Posture

DOCUMENT = json.loads((Path(__file__).parents[1] / "data" / "initial_poses.json").read_text())
POSES = tuple(DOCUMENT["poses"])


def posture(pose: str) -> Posture:
    """A pose of the document in this model's variables."""
    given = DOCUMENT["poses"][pose]
    contacts = given["contacts"]
    joints = {c["finger"]: c["u_rad"] for c in contacts} | given["free_fingers"]
    keys = ("tool_axial_mm", "tool_angle_rad", "finger_arclength_mm", "finger_angle_rad")
    hand = given["hand_in_tool_frame"]
    return Posture(
        fingers=tuple(c["finger"] for c in contacts),
        d=np.array(list(DOCUMENT["design"].values())),
        turn=0.0,
        h=np.array(hand["xyz_mm"] + hand["rpy_rad"]),
        u=np.array([joints[finger] for finger in FINGERS]),
        a=np.array([[c[key] for key in keys] for c in contacts]),
    )


def test_there_are_eleven_contacts():
    assert sum(len(posture(pose).fingers) for pose in POSES) == 11


@pytest.mark.parametrize("pose", POSES)
def test_the_model_finds_them_in_contact(bench: Workbench, pose: str):
    at = posture(pose)
    six, opposition, _, _ = bench.kernels[pose].residual(at.d, 0.0, at.y)
    residual = six.reshape(-1, 6)
    assert np.linalg.norm(residual[:, :3], axis=1).max() <= 1e-6
    assert np.linalg.norm(residual[:, 3:], axis=1).max() <= 1e-8
    assert np.allclose(opposition, 1 - bench.spec.bounds.opposition)


@pytest.mark.parametrize("pose", POSES)
def test_plain_kinematics_finds_them_in_contact(pose: str):
    at = posture(pose)
    for i in range(len(at.fingers)):
        tool, finger = at.tool(i), at.finger(i)
        assert np.linalg.norm(tool.p - finger.p) <= 1e-6
        assert np.linalg.norm(tool.normal + finger.normal) <= 1e-8


@pytest.mark.parametrize("pose", POSES)
def test_nothing_else_touches(bench: Workbench, pose: str):
    at = posture(pose)
    *_, clearances = bench.kernels[pose].residual(at.d, 0.0, at.y)
    assert clearances.min() > -1e-6


@pytest.mark.parametrize("pose", POSES)
def test_the_spec_tells_them_to_its_six_decimals(clay: Spec, bench: Workbench, pose: str):
    assert clay.initial is not None
    told = pose_state(clay.initial.poses[pose], bench.template.names)
    assert np.abs(told - posture(pose).y).max() < 1e-6
