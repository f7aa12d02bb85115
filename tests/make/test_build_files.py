"""A finished build, and the checker that judges it, proven on a hand with one finger."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from tests.make.build_check import check_build
from tests.make.scene_check import check_scene

RADIUS, TOOL_RADIUS = 0.008, 0.006
URDF = """<?xml version="1.0"?>
<robot name="one_finger">
  <link name="palm">
    <collision><origin xyz="{palm}"/><geometry><sphere radius="0.01"/></geometry></collision>
  </link>
  <link name="index_proximal">{proximal}</link>
  <link name="index_distal">{distal}</link>
  <joint name="index_mcp_flex" type="revolute">
    <parent link="palm"/><child link="index_proximal"/><axis xyz="0 1 0"/>
    <limit lower="-0.2" upper="{upper}" velocity="{velocity}" effort="1"/>
  </joint>
  <joint name="index_ip_flex" type="revolute">
    <parent link="index_proximal"/><child link="index_distal"/><axis xyz="0 1 0"/>
    <origin xyz="0.06 0 0"/><limit lower="0" upper="2" velocity="3" effort="1"/>
  </joint>
</robot>
"""


def capsule(length: float) -> str:
    """Collision elements of a capsule along x."""
    ends = "".join(
        f'<collision><origin xyz="{x} 0 0"/><geometry><sphere radius="{RADIUS}"/></geometry>'
        "</collision>"
        for x in (0.0, length)
    )
    return ends + (
        f'<collision><origin xyz="{length / 2} 0 0" rpy="0 {np.pi / 2} 0"/><geometry>'
        f'<cylinder radius="{RADIUS}" length="{length}"/></geometry></collision>'
    )


def swing(knots: int = 201) -> dict:
    """The finger flexes by 0.5 rad and back, and the tool under its distal link goes with it."""
    time = np.linspace(0.0, 2.0, knots)
    u = 0.25 * (1 - np.cos(np.pi * time)) ** 2 / 2
    rate = 0.25 * np.pi * (1 - np.cos(np.pi * time)) * np.sin(np.pi * time)
    bend = (
        0.25
        * np.pi**2
        * (np.sin(np.pi * time) ** 2 + (1 - np.cos(np.pi * time)) * np.cos(np.pi * time))
    )
    zero = np.zeros(knots)
    x, z = 0.08, -RADIUS - TOOL_RADIUS
    position = np.stack(
        [x * np.cos(u) + z * np.sin(u), zero, z * np.cos(u) - x * np.sin(u)], axis=1
    )
    crosswise = np.sqrt(0.5)  # the tool's x along the hand's y, then turned with the finger
    c, s = np.cos(u / 2) * crosswise, np.sin(u / 2) * crosswise
    return {
        "joint_names": ["index_mcp_flex", "index_ip_flex"],
        "time_s": time.tolist(),
        "position_rad": np.stack([u, zero], axis=1).tolist(),
        "velocity_rad_s": np.stack([rate, zero], axis=1).tolist(),
        "acceleration_rad_s2": np.stack([bend, zero], axis=1).tolist(),
        "contacts": [{"finger": "index", "link": "distal"}],
        "tool": {
            "radius_m": TOOL_RADIUS,
            "back_m": -0.05,
            "tip_m": 0.05,
            "angle_rad": u.tolist(),
            "pose_palm": np.column_stack([position, c, s, s, c]).tolist(),
        },
    }


def faults(folder: Path, document: dict, palm="0 0 0.05", upper=1.0, velocity=3.0) -> list[str]:
    """What the checker finds in a build with one finger and one trajectory."""
    (folder / "hand" / "urdf").mkdir(parents=True)
    (folder / "trajectories").mkdir()
    text = URDF.format(
        palm=palm, upper=upper, velocity=velocity, proximal=capsule(0.06), distal=capsule(0.03)
    )
    (folder / "hand" / "urdf" / "one_finger.urdf").write_text(text)
    (folder / "trajectories" / "swing.json").write_text(json.dumps(document))
    return check_build(folder).violations


def test_finished_build_moves_its_tool_in_contact(built_clay: Path):
    check = check_build(built_clay)
    assert check.violations == []
    assert len(check.figures) == 3


def test_finished_build_moves_its_tool_in_contact_for_mujoco_too(built_clay: Path):
    check = check_scene(built_clay)
    assert check.violations == []
    assert len(check.figures) == 3
    for figures in check.figures.values():
        assert figures.keys() == {"gap at knots [mm]", "gap at midpoints [mm]"}


def test_mujoco_finds_a_thicker_tool_in_the_way(built_clay: Path, tmp_path: Path):
    copy = shutil.copytree(built_clay, tmp_path / "clay", ignore=shutil.ignore_patterns("store"))
    scene = copy / "hand" / "mjcf" / "scene.xml"
    text, radius = scene.read_text(), f'size="{0.006!r}"'
    assert text.count(radius) == 1
    scene.write_text(text.replace(radius, f'size="{0.00605!r}"'))
    assert any("index_distal is -0.05" in fault for fault in check_scene(copy).violations)


def test_good_files_have_no_faults(tmp_path: Path):
    assert faults(tmp_path, swing()) == []


def test_gap_of_50_micrometres_is_found(tmp_path: Path):
    document = swing()
    document["tool"]["radius_m"] -= 5e-5
    assert "swing: index_distal is 0.0500 mm off the tool at 0.000 s (knots)" in faults(
        tmp_path, document
    )


def test_gap_between_knots_is_found(tmp_path: Path):
    found = faults(tmp_path, swing(knots=21))
    assert found and all("(midpoints)" in fault for fault in found)


def test_contact_beyond_a_fingertip_is_found(tmp_path: Path):
    document = swing()
    for row in document["tool"]["pose_palm"]:
        row[:3] = np.array(row[:3]) * 1.5
    assert any("off the tool" in fault for fault in faults(tmp_path, document))


def test_contact_at_the_rim_of_the_tool_is_found(tmp_path: Path):
    document = swing(knots=401)
    document["tool"]["tip_m"] = -0.002
    closer = 1 - np.sqrt(0.014**2 - 0.002**2) / 0.014
    for row, u in zip(document["tool"]["pose_palm"], document["tool"]["angle_rad"], strict=True):
        row[0] += 0.014 * closer * np.sin(u)
        row[2] += 0.014 * closer * np.cos(u)
    assert "swing: index_distal meets the tool askew at 0.000 s (knots)" in faults(
        tmp_path, document
    )


def test_penetration_by_another_link_is_found(tmp_path: Path):
    found = faults(tmp_path, swing(), palm="0.08 0.02 -0.0299")
    assert any("palm is 0.1" in fault and "inside the tool at 0.000 s" in fault for fault in found)


def test_contact_of_an_undeclared_link_is_found(tmp_path: Path):
    document = swing()
    document["contacts"] = []
    document["tool"]["radius_m"] += 5e-5
    assert any("index_distal is 0.0500 mm inside" in fault for fault in faults(tmp_path, document))


def test_joint_limit_is_checked(tmp_path: Path):
    assert faults(tmp_path, swing(), upper=0.49) == ["swing: joint limit passed by 0.01 rad"]


def test_velocity_limit_is_checked(tmp_path: Path):
    assert any(
        "velocity limit passed" in fault for fault in faults(tmp_path, swing(), velocity=0.5)
    )


@pytest.mark.parametrize("key", ["velocity_rad_s", "acceleration_rad_s2"])
def test_motion_that_does_not_end_at_rest_is_found(tmp_path: Path, key: str):
    document = swing()
    document[key][-1][0] += 1e-3
    assert faults(tmp_path, document) == ["swing: not at rest at the end"]


def test_time_that_stands_still_is_found(tmp_path: Path):
    document = swing()
    document["time_s"][5] = document["time_s"][4]
    assert "swing: time does not increase from 0" in faults(tmp_path, document)


def test_tool_angle_that_differs_from_its_pose_is_found(tmp_path: Path):
    document = swing()
    document["tool"]["angle_rad"][7] += 1e-3
    assert any("poses and angles differ by" in fault for fault in faults(tmp_path, document))


def test_build_without_files_is_found(tmp_path: Path):
    assert check_build(tmp_path).violations == [f"{tmp_path}: 0 URDF and 0 trajectories"]
