"""Packages of other make: ROS packages, xacro alone, no MuJoCo at hand; and the verb's words."""

from __future__ import annotations

import json
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh
from typer.testing import CliRunner

from fpcad.check_description import check_description
from fpcad.check_description.shapes import Shape, outside_hull
from fpcad.cli import app
from fpcad.errors import StoreError
from tests.check_description.test_broken_packages import URDF, gone, text

PENDULUM = """<robot name="pendulum">
  <link name="base"><visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>
    <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <link name="bob">
    <inertial><mass value="0.1"/>
      <inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><mesh filename="package://swing/meshes/bob.stl" scale="0.001 0.001 0.001"/>
    </geometry></visual>
    <collision><geometry><capsule radius="0.03" length="0.1"/></geometry></collision>
  </link>
  <joint name="hinge" type="revolute"><parent link="base"/><child link="bob"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="2"/></joint>
</robot>
"""


def verdicts(folder: Path) -> dict[str, str]:
    return {row.check: row.verdict for row in check_description(folder).rows}


@pytest.fixture
def swing(tmp_path: Path) -> Path:
    """A ROS package of somebody else, its mesh in millimetres, in a folder of another name."""
    folder = tmp_path / "download-main"
    (folder / "meshes").mkdir(parents=True)
    (folder / "urdf").mkdir()
    (folder / "package.xml").write_text("<package><name>swing</name></package>")
    (folder / "urdf" / "pendulum.urdf").write_text(PENDULUM)
    trimesh.creation.capsule(100.0, 30.0).apply_translation((0, 0, -50)).export(
        folder / "meshes" / "bob.stl"
    )
    return folder


def test_anothers_package_is_checked_as_far_as_it_goes(swing):
    found = verdicts(swing)
    assert {check for check, verdict in found.items() if verdict == "skipped"} == {
        "MJCF",
        "transmission",
        "joint limits",
    }
    assert "faulty" not in found.values()


def test_millimetres_taken_for_metres_are_found(swing):
    text(' scale="0.001 0.001 0.001"', "", "urdf/pendulum.urdf")(swing)
    assert verdicts(swing)["scale"] == "faulty"


def test_a_fixed_frame_needs_no_mass(swing):
    frame = """<link name="tip"><inertial><mass value="0"/>
      <inertia ixx="0" iyy="0" izz="0" ixy="0" ixz="0" iyz="0"/></inertial></link>
      <joint name="to_tip" type="fixed"><parent link="bob"/><child link="tip"/></joint></robot>"""
    text("</robot>", frame, "urdf/pendulum.urdf")(swing)
    assert "faulty" not in verdicts(swing).values()


def test_a_package_of_xacro_alone_is_expanded(package):
    shutil.rmtree(package / "urdf")
    report = check_description(package)
    assert {row.robot for row in report.rows} == {"clay_description/urdf/clay.urdf.xacro"}
    assert report.is_good


def test_xacro_that_cannot_be_expanded_is_told(package):
    shutil.rmtree(package / "urdf")
    gone("clay_description/urdf/clay.xacro")(package)
    row, *others = check_description(package).rows
    assert (row.check, row.verdict, others) == ("readable", "faulty", [])


def test_without_mujoco_its_check_is_skipped_and_says_so(package, monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    rows = {row.check: row for row in check_description(package).rows}
    assert rows["MJCF"].verdict == "skipped" and "fpcad[physics]" in rows["MJCF"].reason


def test_a_finished_build_is_described_without_fault(built_clay):
    report = check_description(built_clay / "hand")
    assert [row for row in report.rows if row.verdict != "good"] == []


def test_a_folder_without_a_robot_is_an_error(tmp_path):
    with pytest.raises(StoreError, match="urdf"):
        check_description(tmp_path)


@pytest.mark.parametrize(
    ("kind", "size"),
    [
        ("box", (0.2, 0.3, 0.4)),
        ("sphere", (0.2,)),
        ("cylinder", (0.1, 0.4)),
        ("capsule", (0.1, 0.4)),
    ],
)
def test_a_primitive_contains_its_own_surface_and_no_more(kind, size):
    pose = trimesh.transformations.random_rotation_matrix(np.array([0.1, 0.4, 0.8]))
    pose[:3, 3] = 0.3, -0.2, 0.1
    shape = Shape(kind, pose, size)
    surface = shape.mesh.vertices
    away = surface - pose[:3, 3]
    assert shape.contains(surface, 1e-9).all()
    assert not shape.contains(pose[:3, 3] + 1.05 * away, 1e-9).any()


def test_distance_from_a_hull_is_that_of_its_farthest_face():
    box = trimesh.creation.box((2.0, 2.0, 2.0))
    assert outside_hull(box, np.array([[0.0, 0, 0], [0.5, 0, 0], [3.0, 0, 0]])) == pytest.approx(
        [-1.0, -0.5, 2.0]
    )


def test_the_verb_prints_a_table_and_exits_with_0_for_a_good_package(package):
    result = CliRunner().invoke(app, ["check-description", str(package)])
    assert result.exit_code == 0, result.output
    assert "readable" in result.output and "faulty" not in result.output


def test_the_verb_exits_with_7_for_a_faulty_package(package):
    text('effort="[^"]*"', 'effort="100"', URDF)(package)
    result = CliRunner().invoke(app, ["check-description", str(package), "--json"])
    assert result.exit_code == 7
    told = json.loads(result.stdout)
    assert told["good"] is False
    faulty = {row["check"]: row for row in told["rows"] if row["verdict"] == "faulty"}
    assert faulty.keys() == {"MJCF", "effort", "joint limits"}
    assert "thumb_mcp_flex" in faulty["effort"]["faults"][0]["subject"]
