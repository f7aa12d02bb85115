"""Hands of simple meshes, described in no time: solid modelling takes many seconds."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import trimesh
from numpy.typing import NDArray

from fpcad.make.description import LinkBody, describe, write_description
from fpcad.make.description.robot import Robot
from fpcad.make.grip import ContactLink
from fpcad.make.inertia import inertia_of
from fpcad.make.mesh import in_metres, stl_bytes
from fpcad.make.trajectory import ToolMotion, Trajectory
from fpcad.make.transmission_file import transmission_yaml
from fpcad.model.geometry import HandGeometry
from tests.make.hands import CENTRE, CLAY, STAMP, TEMPLATE, geometry_of

Array = NDArray[np.float64]

NAMES = TEMPLATE.names
JOINTS = tuple(f"{finger}_{joint}" for finger in NAMES.fingers for joint in NAMES.joints)
DENSITY_G_CM3 = {"endoskeleton": 1.24, "skin": 1.12}
PARTS = {
    "palm": (("palm", "endoskeleton"),),
    "mcp": (("mcp_cross", "endoskeleton"),),
    "proximal": (("proximal_bone", "endoskeleton"), ("proximal_skin", "skin")),
    "distal": (("distal_bone", "endoskeleton"), ("distal_skin", "skin")),
}
"""Mesh and material of each link's parts."""


def nod(preload: bool = False) -> Trajectory:
    """A short motion of all joints with the tool resting 80 mm before the palm."""
    time = np.linspace(0.0, 1.0, 5)
    position = np.tile([0.3, 0.02, 0.4], 4) + 0.1 * np.sin(np.pi * time)[:, None]
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


def simple_robot(values: tuple[float, ...]) -> Robot:
    """Description of the hand with d1 to d6 [mm, deg]."""
    geometry = geometry_of(values)
    meshes = simple_meshes(geometry)
    bodies = {
        link: LinkBody(inertia_of((meshes[m], DENSITY_G_CM3[of]) for m, of in parts), parts)
        for link, parts in PARTS.items()
    }
    return describe(CLAY, geometry, bodies, TRAJECTORIES)


def write_simple_hand(values: tuple[float, ...], hand: Path) -> Path:
    """Write a whole `hand` folder and return it."""
    for name, mesh in simple_meshes(geometry_of(values)).items():
        STAMP.write(hand / "meshes" / "visual" / f"{name}.stl", stl_bytes(in_metres(mesh)))
    write_description(simple_robot(values), TRAJECTORIES, hand, STAMP)
    STAMP.write(hand / "transmission.yaml", transmission_yaml(CLAY, geometry_of(CENTRE)))
    return hand


def simple_meshes(geometry: HandGeometry) -> dict[str, trimesh.Trimesh]:
    """Mesh [mm] of each part: bones half as thick as their links, skins around them."""
    radius, zero = geometry.radius_mm, np.zeros(3)
    palm = [capsule(s.start_mm, s.end_mm, s.radius_mm) for s in geometry.palm]
    meshes = {
        "palm": trimesh.util.concatenate(palm),
        "mcp_cross": trimesh.creation.box((10.0, 8.0, 9.0)),
    }
    lengths = {
        "proximal": geometry.proximal_length_mm,
        "distal": geometry.distal_length_mm - radius,
    }
    for link, length in lengths.items():
        end = np.array([length, 0.0, 0.0])
        meshes[f"{link}_bone"] = capsule(zero, end, radius / 2)
        meshes[f"{link}_skin"] = capsule(zero, end, radius)
    return meshes


def capsule(start: Array, end: Array, radius: float) -> trimesh.Trimesh:
    """Mesh of a capsule; a sphere if its ends coincide."""
    ball = trimesh.creation.icosphere(2, radius).vertices
    return trimesh.convex.convex_hull(np.vstack([ball + start, ball + end]))
