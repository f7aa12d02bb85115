"""The description's files in a build's `hand` folder."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from fpcad.make.description.gltf import hand_glb
from fpcad.make.description.mjcf import hand_mjcf, scene_mjcf
from fpcad.make.description.robot import Robot
from fpcad.make.description.ros_package import write_ros_package
from fpcad.make.description.urdf import urdf_text
from fpcad.make.documents.stamp import Stamp
from fpcad.make.trajectory import Trajectory


def write_description(
    robot: Robot, trajectories: Mapping[str, Trajectory], hand: Path, stamp: Stamp
) -> list[Path]:
    """Write every description of a hand into its folder, in which the visual meshes are already."""
    name, meshes = robot.name, hand / "meshes" / "visual"
    return [
        stamp.write(hand / "urdf" / f"{name}.urdf", urdf_text(robot)),
        stamp.write(hand / "mjcf" / f"{name}.xml", hand_mjcf(robot)),
        stamp.write(hand / "mjcf" / "scene.xml", scene_mjcf(robot)),
        stamp.write(hand / f"{name}.glb", hand_glb(robot, meshes)),
        *write_ros_package(robot, trajectories, meshes, hand, stamp),
    ]
