"""The description's files in a build's `hand` folder."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from fpcad.make.description.gltf import hand_glb
from fpcad.make.description.mjcf import hand_mjcf, scene_mjcf
from fpcad.make.description.robot import Robot
from fpcad.make.description.ros_package import write_ros_package
from fpcad.make.description.urdf import urdf_text
from fpcad.make.trajectory import Trajectory
from fpcad.store import write_whole


def write_description(
    robot: Robot, trajectories: Mapping[str, Trajectory], hand: Path
) -> list[Path]:
    """Write every description of a hand into its folder, in which the visual meshes are already."""
    name, meshes = robot.name, hand / "meshes" / "visual"
    return [
        write_whole(hand / "urdf" / f"{name}.urdf", urdf_text(robot)),
        write_whole(hand / "mjcf" / f"{name}.xml", hand_mjcf(robot)),
        write_whole(hand / "mjcf" / "scene.xml", scene_mjcf(robot)),
        write_whole(hand / f"{name}.glb", hand_glb(robot, meshes)),
        *write_ros_package(robot, trajectories, meshes, hand),
    ]
