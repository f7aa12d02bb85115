"""State vectors: where their parts lie and what their columns are called."""

from __future__ import annotations

import numpy as np
import pytest

from fpcad.model.pose import StateLayout
from fpcad.model.state import pose_state, state_columns
from fpcad.spec.schema import Spec
from fpcad.spec.templates import TEMPLATES

NAMES = TEMPLATES["anthropomorphic_4f"]
LAYOUT = StateLayout(n_fingers=4, n_joints=3, n_contacts=3)


def test_parts_fill_the_state_without_overlap():
    places = np.arange(LAYOUT.size)
    parts = [places[LAYOUT.hand], places[LAYOUT.joints], places[LAYOUT.contacts]]
    assert np.array_equal(np.concatenate(parts), places)
    assert [len(part) for part in parts] == [6, 12, 12]


def test_every_entry_has_its_column():
    columns = state_columns("grip", NAMES, LAYOUT)
    assert len(columns) == len(set(columns)) == LAYOUT.size
    assert columns[0] == "grip.hand_x_mm" and columns[5] == "grip.hand_yaw_rad"
    assert columns[LAYOUT.joints][4] == "grip.index_mcp_abd_rad"
    assert columns[LAYOUT.contacts][-2] == "grip.contact2_arclength_mm"


def test_lengths_count_ten_times_less_than_angles():
    lengths = ["_mm" in column for column in state_columns("grip", NAMES, LAYOUT)]
    assert LAYOUT.scale.tolist() == [10.0 if length else 1.0 for length in lengths]


@pytest.mark.parametrize("pose", ["carve", "poke", "press"])
def test_words_become_numbers_at_their_places(clay: Spec, pose: str):
    assert clay.initial is not None
    given = clay.initial.poses[pose]
    y = pose_state(given, NAMES)
    named = dict(
        zip(state_columns(pose, NAMES, StateLayout(4, 3, len(given.contacts))), y, strict=True)
    )
    assert named[f"{pose}.hand_y_mm"] == given.hand_position_mm[1]
    assert named[f"{pose}.hand_pitch_rad"] == np.radians(given.hand_rotation_deg[1])
    assert named[f"{pose}.middle_ip_flex_rad"] == np.radians(given.joints_deg["middle"][2])
    assert named[f"{pose}.contact2_tool_axial_mm"] == given.contacts[2].axial_mm
    assert named[f"{pose}.contact2_finger_angle_rad"] == np.radians(
        given.contacts[2].finger_angle_deg
    )
