"""The description's files in a build's `hand` folder."""

from __future__ import annotations

from pathlib import Path

from fpcad.make.description.mjcf import hand_mjcf, scene_mjcf
from fpcad.make.description.robot import Robot
from fpcad.make.description.urdf import urdf_text
from fpcad.store import write_whole


def write_description(robot: Robot, hand: Path) -> list[Path]:
    """Write every description of a hand into its folder, whose visual meshes are there already."""
    name = robot.name
    return [
        write_whole(hand / "urdf" / f"{name}.urdf", urdf_text(robot)),
        write_whole(hand / "mjcf" / f"{name}.xml", hand_mjcf(robot)),
        write_whole(hand / "mjcf" / "scene.xml", scene_mjcf(robot)),
    ]
