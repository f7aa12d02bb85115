"""The hand as one binary glTF file, for browsers and viewers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import trimesh
from numpy.typing import NDArray
from trimesh.exchange.gltf import export_glb
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

from fpcad.make.description.robot import BASE_LINK, COLOURS, Robot

Array = NDArray[np.float64]

SHARP_EDGE_RAD = np.radians(30.0)
"""Facets that meet at a smaller angle are shaded as one smooth face."""
UPRIGHT = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
"""glTF's y points up where the hand's z does."""


def hand_glb(robot: Robot, meshes: Path) -> bytes:
    """The hand with straight fingers; each link is a node, so viewers can pose it.

    Args:
        robot: the hand.
        meshes: folder of its visual meshes [m].
    """
    scene = trimesh.Scene(base_frame="world")
    scene.graph.update(BASE_LINK, "world", matrix=UPRIGHT)
    for joint in robot.joints:
        scene.graph.update(joint.child, joint.parent, matrix=joint.pose)
    for link in robot.links:
        for mesh, material in link.body.visuals:
            if mesh not in scene.geometry:
                scene.geometry[mesh] = _shaded(meshes / f"{mesh}.stl", material)
            scene.graph.update(f"{link.name} {mesh}", link.name, geometry=mesh)
    return bytes(export_glb(scene, include_normals=True))


def _shaded(file: Path, material: str) -> trimesh.Trimesh:
    """A mesh with vertex normals and its material: dull, for a metallic one renders black."""
    mesh = trimesh.load_mesh(file)
    smooth = trimesh.graph.smooth_shade(mesh, angle=SHARP_EDGE_RAD)
    colour = np.array(COLOURS[material])
    look = PBRMaterial(
        name=material, baseColorFactor=colour, metallicFactor=0.0, roughnessFactor=0.7
    )
    smooth.visual = TextureVisuals(material=look)
    return smooth
