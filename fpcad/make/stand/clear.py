"""How near a jig comes to a hand's parts, exactly."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import manifold3d
import numpy as np
import trimesh
from numpy.typing import NDArray

from fpcad.make.gates.bodies import Body, body_poses
from fpcad.make.mesh import manifold_of
from fpcad.make.stand.jig_place import AWAY_MM, AWAY_STEP_MM
from fpcad.model.geometry import HandGeometry

Array = NDArray[np.float64]


@dataclass(frozen=True)
class BoltedHand:
    """A hand where it is bolted to its stand."""

    bodies: Sequence[Body]
    geometry: HandGeometry
    T_palm_stand: Array  # (4, 4) [mm]


TOLD_MM = 5.0
"""Gaps beyond this are told as this."""


def least_gap(
    jig: trimesh.Trimesh, away: Array, postures: Sequence[Array], hand: BoltedHand
) -> float:
    """Least distance [mm] of a jig, in the stand's frame, to a hand; zero where they meet.

    Args:
        away: (3,) unit vector along which the jig is drawn away from the first posture.
        postures: joints (n_fingers, 3) [rad]; in the others the jig is in its place.
    """
    gap, body = TOLD_MM, manifold_of(jig)
    for number, piece, bounds in _pieces(postures, hand):
        for step in np.arange(0.0, AWAY_MM, AWAY_STEP_MM) if number == 0 else np.zeros(1):
            if _boxes_apart(jig.bounds + step * away, bounds) < gap:
                moved = body.translate([float(x) for x in step * away])
                gap = min(gap, float(piece.min_gap(moved, gap)))
                if gap <= 0:
                    return 0.0
    return gap


def shared_volume(still: trimesh.Trimesh, postures: Sequence[Array], hand: BoltedHand) -> float:
    """Largest volume [mm^3] that one of the hand's pieces shares with a part of the stand."""
    body = manifold_of(still)
    volumes = [
        float((body ^ piece).volume())
        for _, piece, bounds in _pieces(postures, hand)
        if _boxes_apart(still.bounds, bounds) == 0
    ]
    return max(volumes, default=0.0)


def _pieces(
    postures: Sequence[Array], hand: BoltedHand
) -> Iterator[tuple[int, manifold3d.Manifold, Array]]:
    """Each posture's number and each body there, in the stand's frame, with its bounds (2, 3).

    What no joint moves comes with the first posture alone.
    """
    T_stand_palm = np.linalg.inv(hand.T_palm_stand)
    for number, joints in enumerate(postures):
        for body in hand.bodies:
            if number == 0 or not body.still:
                pose = T_stand_palm @ body_poses(body, hand.geometry, joints[None])[0]
                piece = body.solid.transform(pose[:3])
                yield number, piece, np.array(piece.bounding_box()).reshape(2, 3)


def _boxes_apart(a: Array, b: Array) -> float:
    """Distance [mm] of two axis-parallel boxes (2, 3)."""
    return float(np.linalg.norm(np.maximum(np.maximum(a[0] - b[1], b[0] - a[1]), 0.0)))
