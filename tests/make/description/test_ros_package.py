"""The ROS 2 package, read without ROS: by xacro, yourdfpy, pinocchio and parsers of XML and YAML."""

from __future__ import annotations

import ast
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports]
import pytest
import xacro
import yourdfpy
from ruamel.yaml import YAML

from tests.make.hands import CENTRE, CLAY
from tests.make.simple_hand import JOINTS, TRAJECTORIES, nod


@pytest.fixture
def package(described) -> Path:
    return described[CENTRE] / "clay_description"


@pytest.fixture
def limits(package) -> dict:
    return YAML(typ="safe").load(package / "config" / "joint_limits.yaml")["joint_limits"]


def expanded(package: Path, **arguments: str) -> str:
    """The URDF that the package's xacro stands for."""
    file = package / "urdf" / "clay.urdf.xacro"
    document: Any = xacro.process_file(str(file), mappings=arguments)
    return document.toxml()


def load(package: Path, tmp_path: Path, **arguments: str) -> yourdfpy.URDF:
    """The same, read by yourdfpy, its meshes too."""
    urdf = tmp_path / "expanded.urdf"
    urdf.write_text(expanded(package, **arguments))

    def find(fname: str) -> str:
        return fname.replace("package://clay_description", str(package))

    return yourdfpy.URDF.load(str(urdf), filename_handler=find)


def test_expanded_xacro_is_the_hand_on_a_world(package, tmp_path):
    robot = load(package, tmp_path)
    assert robot.base_link == "world"
    assert tuple(robot.actuated_joint_names) == JOINTS
    relative = yourdfpy.URDF.load(str(package.parent / "urdf" / "clay.urdf"))
    posture = dict(zip(JOINTS, nod().position_rad[2], strict=True))
    for reader in (robot, relative):
        reader.update_cfg(posture)
    for link in relative.link_map:
        assert np.array_equal(
            robot.get_transform(link, "palm"), relative.get_transform(link, "palm")
        )


def test_every_mesh_of_the_package_is_found_and_is_the_hands(package, tmp_path):
    meshes = load(package, tmp_path).scene.geometry
    assert len(meshes) == 1 + 4 * 5
    for file in (package / "meshes" / "visual").iterdir():
        original = package.parent / "meshes" / "visual" / file.name
        assert file.read_bytes() == original.read_bytes()


def test_prefix_comes_before_every_name(package, tmp_path):
    robot = load(package, tmp_path, prefix="left_")
    names = [*robot.link_map, *robot.joint_map, *(m.name for m in robot.robot.materials)]
    assert [name for name in names if not name.startswith("left_")] == ["world"]


def test_without_a_parent_the_palm_is_the_root(package, tmp_path):
    assert load(package, tmp_path, parent="").base_link == "palm"


def test_pinocchio_reads_what_xacro_expands(package):
    model = pin.buildModelFromXML(expanded(package, prefix="left_"))
    assert sorted(model.names[1:]) == sorted(f"left_{joint}" for joint in JOINTS)


def test_control_is_by_joint_position_on_mock_hardware(package):
    control = ET.fromstring(expanded(package)).find("ros2_control")
    assert control is not None
    assert control.findtext("hardware/plugin") == "mock_components/GenericSystem"
    joints = {joint.get("name"): joint for joint in control.findall("joint")}
    assert tuple(joints) == JOINTS
    for joint in joints.values():
        assert [c.get("name") for c in joint.findall("command_interface")] == ["position"]
        states = [state.get("name") for state in joint.findall("state_interface")]
        assert states == ["position", "velocity"]


def test_another_plugin_takes_the_mocks_place(package):
    control = ET.fromstring(expanded(package, plugin="my/Bus")).find("ros2_control")
    assert control is not None and control.findtext("hardware/plugin") == "my/Bus"


def test_limits_of_urdf_and_file_are_the_same(package, limits):
    robot = ET.fromstring(expanded(package))
    for joint in robot.findall("joint[@type='revolute']"):
        limit, soft = joint.find("limit"), joint.find("safety_controller")
        own = limits[joint.get("name")]
        assert limit is not None and soft is not None
        for key, attribute in (
            ("min_position", "lower"),
            ("max_position", "upper"),
            ("max_velocity", "velocity"),
            ("max_effort", "effort"),
        ):
            assert own[key] == float(limit.get(attribute, "nan"))
        for key in ("soft_lower_limit", "soft_upper_limit", "k_position", "k_velocity"):
            assert own[key] == float(soft.get(key, "nan"))


def test_limits_have_accelerations_and_soft_ones_lie_inside(limits):
    assert tuple(limits) == JOINTS
    for own in limits.values():
        assert own["has_acceleration_limits"]
        expected = np.radians(CLAY.motion.joint_acceleration_deg_s2)
        assert own["max_acceleration"] == pytest.approx(expected)
        assert own["min_position"] < own["soft_lower_limit"]
        assert own["soft_upper_limit"] < own["max_position"]


def test_controllers_move_all_joints(package):
    file = YAML(typ="safe").load(package / "config" / "controllers.yaml")
    controller = file["hand_controller"]["ros__parameters"]
    assert tuple(controller["joints"]) == JOINTS
    assert controller["command_interfaces"] == ["position"]


def test_srdf_leaves_the_pairs_that_can_meet(package, described):
    urdf = described[CENTRE] / "urdf" / "clay.urdf"
    model = pin.buildModelFromUrdf(str(urdf))
    shapes = pin.buildGeomFromUrdf(model, str(urdf), pin.GeometryType.COLLISION)
    shapes.addAllCollisionPairs()
    pin.removeCollisionPairs(model, shapes, str(package / "config" / "clay.srdf"))

    def link(shape: int) -> str:
        return model.frames[shapes.geometryObjects[shape].parentFrame].name

    left = {frozenset((link(p.first), link(p.second))) for p in shapes.collisionPairs}
    left = {pair for pair in left if len(pair) == 2}  # pinocchio pairs shapes of one link too
    assert frozenset(("palm", "index_distal")) in left
    assert frozenset(("palm", "index_proximal")) not in left
    assert frozenset(("ring_proximal", "ring_distal")) not in left
    assert len(left) == 4 + 4 * 6  # palm and distals, then two links of each pair of fingers


def test_srdf_names_the_poses(package):
    root = ET.parse(package / "config" / "clay.srdf").getroot()
    states = {state.get("name"): state for state in root.findall("group_state")}
    assert states.keys() == TRAJECTORIES.keys()
    angles = {j.get("name"): float(j.get("value", "nan")) for j in states["nod"].findall("joint")}
    assert angles == dict(zip(JOINTS, nod().position_rad[0], strict=True))


@pytest.mark.parametrize("pose", TRAJECTORIES)
def test_motions_have_the_shape_of_the_message(package, pose):
    message = YAML(typ="safe").load(package / "trajectories" / f"{pose}.yaml")
    trajectory = TRAJECTORIES[pose]
    assert message.keys() == {"header", "joint_names", "points"}
    assert tuple(message["joint_names"]) == JOINTS
    for point, time, position in zip(
        message["points"], trajectory.time_s, trajectory.position_rad, strict=True
    ):
        since = point["time_from_start"]
        assert since["sec"] + 1e-9 * since["nanosec"] == pytest.approx(time, abs=1e-9)
        assert 0 <= since["nanosec"] < 10**9
        assert point["positions"] == position.tolist()
        assert len(point["velocities"]) == len(point["accelerations"]) == len(JOINTS)


def test_commands_that_grip_are_a_message_of_their_own(package):
    names = {file.name for file in (package / "trajectories").iterdir()}
    assert names == {"nod.yaml", "tight.yaml", "tight.preload.yaml"}
    message = YAML(typ="safe").load(package / "trajectories" / "tight.preload.yaml")
    expected = TRAJECTORIES["tight"].position_preload_rad
    assert expected is not None
    assert [point["positions"] for point in message["points"]] == expected.tolist()
    assert all(point["velocities"] == point["accelerations"] == [] for point in message["points"])


def test_launch_files_are_python_and_start_what_the_package_depends_on(package):
    needed = {e.text for e in ET.parse(package / "package.xml").getroot().iter("exec_depend")}
    for file in (package / "launch").iterdir():
        tree = ast.parse(file.read_text(), file.name)
        started = {
            keyword.value.value
            for call in ast.walk(tree)
            if isinstance(call, ast.Call)
            for keyword in call.keywords
            if keyword.arg == "package" and isinstance(keyword.value, ast.Constant)
        }
        assert started and started <= needed


def test_cmake_installs_every_folder(package):
    text = (package / "CMakeLists.txt").read_text()
    for folder in package.iterdir():
        assert not folder.is_dir() or folder.name in text
