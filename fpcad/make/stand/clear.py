"""How near a jig comes to a hand's parts, exactly."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import trimesh
from numpy.typing import NDArray

from fpcad.make.documents.views import hand_pieces
from fpcad.make.mesh import manifold_of
from fpcad.make.parts.assembly import Assembly
from fpcad.make.stand.jig_place import AWAY_MM, AWAY_STEP_MM
from fpcad.model.geometry import HandGeometry

Array = NDArray[np.float64]

TOLD_MM = 5.0
"""Gaps beyond this are told as this."""


def least_gap(
    jig: trimesh.Trimesh,
    away: Array,
    assembly: Assembly,
    geometry: HandGeometry,
    postures: Sequence[Array],
    T_palm_stand: Array,
) -> float:
    """Least distance [mm] of a jig, in the stand's frame, to a hand; zero where they meet.

    Args:
        away: (3,) unit vector along which the jig is drawn away from the first posture.
        postures: joints (n_fingers, 3) [rad]; in the others the jig is in its place.
    """
    here = np.zeros(1)
    gap = TOLD_MM
    for number, joints in enumerate(postures):
        steps = np.arange(0.0, AWAY_MM, AWAY_STEP_MM) if number == 0 else here
        pieces = [
            mesh.copy().apply_transform(np.linalg.inv(T_palm_stand))
            for mesh, _ in hand_pieces(assembly, geometry, joints)
        ]
        for piece in pieces:
            near = [s for s in steps if _boxes_apart(jig.bounds + s * away, piece.bounds) < gap]
            if not near:
                continue
            body, tool = manifold_of(piece), manifold_of(jig)
            for step in near:
                moved = tool.translate([float(x) for x in step * away])
                gap = min(gap, float(body.min_gap(moved, gap)))
                if gap <= 0:
                    return 0.0
    return gap


def shared_volume(
    still: trimesh.Trimesh,
    assembly: Assembly,
    geometry: HandGeometry,
    postures: Sequence[Array],
    T_palm_stand: Array,
) -> float:
    """Largest volume [mm^3] that one of the hand's pieces shares with a part of the stand."""
    body, T = manifold_of(still), np.linalg.inv(T_palm_stand)
    volumes = [0.0]
    for joints in postures:
        for mesh, _ in hand_pieces(assembly, geometry, joints):
            piece = mesh.copy().apply_transform(T)
            if _boxes_apart(still.bounds, piece.bounds) == 0:
                volumes.append(float((body ^ manifold_of(piece)).volume()))
    return max(volumes)


def _boxes_apart(a: Array, b: Array) -> float:
    """Distance [mm] of two axis-parallel boxes (2, 3)."""
    return float(np.linalg.norm(np.maximum(np.maximum(a[0] - b[1], b[0] - a[1]), 0.0)))
