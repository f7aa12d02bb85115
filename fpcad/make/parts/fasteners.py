"""Meshes of screws, nuts and inserts: their envelopes, for checks of interference and pictures.

Each in its own frame [mm], z along the thread: a screw's head ends at z = 0 and its shank begins there; a
nut and an insert begin at z = 0.
"""

from __future__ import annotations

import math

import numpy as np
import trimesh

from fpcad.make.parts.catalogue import Insert, Nut, Screw

SECTIONS = 32


def screw_mesh(screw: Screw, length_mm: float) -> trimesh.Trimesh:
    """A socket head cap screw without its socket."""
    head, shank, z = screw.head_diameter_mm / 2, screw.thread_mm / 2, screw.head_height_mm
    outline = [(0, -z), (head, -z), (head, 0), (shank, 0), (shank, length_mm), (0, length_mm)]
    return trimesh.creation.revolve(np.array(outline, dtype=float), sections=SECTIONS)


def insert_mesh(insert: Insert) -> trimesh.Trimesh:
    """A heat-set insert, its bore filled."""
    return _from_zero(insert.outer_mm / 2, insert.length_mm, SECTIONS)


def nut_mesh(nut: Nut) -> trimesh.Trimesh:
    """A hexagon nut, its bore filled; two of its flats face x."""
    corner = nut.across_flats_mm / 2 / math.cos(math.pi / 6)
    mesh = _from_zero(corner, nut.height_mm, 6)
    return mesh.apply_transform(trimesh.transformations.rotation_matrix(math.pi / 6, [0, 0, 1]))


def _from_zero(radius: float, height: float, sections: int) -> trimesh.Trimesh:
    mesh = trimesh.creation.cylinder(radius, height, sections=sections)
    mesh.apply_translation((0, 0, height / 2))
    return mesh
