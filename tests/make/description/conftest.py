"""Described hands of several shapes, and the files that describe them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from fpcad.make.description import describe, write_description
from fpcad.make.description.robot import Robot
from fpcad.make.grip import ContactLink
from fpcad.make.hand import link_bodies
from fpcad.make.mesh import in_metres, stl_bytes
from fpcad.make.parts.part import Part
from fpcad.make.trajectory import ToolMotion, Trajectory
from fpcad.store import write_whole
from tests.make.hands import CENTRE, CLAY, CORNERS, TEMPLATE, geometry_of

NAMES = TEMPLATE.names
JOINTS = tuple(f"{finger}_{joint}" for finger in NAMES.fingers for joint in NAMES.joints)


def nod(preload: bool = False) -> Trajectory:
    """A short motion of all joints with the tool resting 80 mm before the palm."""
    time = np.linspace(0.0, 1.0, 5)
    start = np.tile([0.3, 0.02, 0.4], 4)
    position = start + 0.1 * np.sin(np.pi * time)[:, None]
    zero = np.zeros_like(position)
    pose = np.tile([0.0, 0.0, -0.08, np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)], (5, 1))
    return Trajectory(
        joint_names=JOINTS,
        time_s=time,
        position_rad=position,
        velocity_rad_s=zero,
        acceleration_rad_s2=zero,
        contacts=(ContactLink("thumb", "distal"),),
        tool=ToolMotion(0.006, -0.08, 0.08, np.zeros(5), pose),
        position_preload_rad=position + 0.05 if preload else None,
    )


TRAJECTORIES: Mapping[str, Trajectory] = {"nod": nod(), "tight": nod(preload=True)}


def robot_of(parts: Mapping[str, Part], values: tuple[float, ...]) -> Robot:
    """Description of a hand with clay's parts, whatever its other dimensions are."""
    bodies = link_bodies(CLAY, list(parts.values()))
    return describe(CLAY, geometry_of(values), bodies, TRAJECTORIES)


@pytest.fixture(scope="session")
def robot(clay_parts: dict[str, Part]) -> Robot:
    """The hand at the centre of clay's box."""
    return robot_of(clay_parts, CENTRE)


@pytest.fixture(scope="session")
def described(
    clay_parts: dict[str, Part], tmp_path_factory: pytest.TempPathFactory
) -> dict[tuple[float, ...], Path]:
    """The `hand` folders of hands of several shapes, by design."""
    folders = {}
    for values in (CENTRE, *CORNERS):
        folders[values] = tmp_path_factory.mktemp("described") / "hand"
        for part in clay_parts.values():
            mesh = folders[values] / "meshes" / "visual" / f"{part.name}.stl"
            write_whole(mesh, stl_bytes(in_metres(part.mesh)))
        write_description(robot_of(clay_parts, values), TRAJECTORIES, folders[values])
    return folders
