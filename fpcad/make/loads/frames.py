"""Where a finger's contact, links and strands are, seen from the frame that its flexion carries."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fpcad.make.parts.bone import ip_tangents
from fpcad.make.parts.dimensions import Dimensions
from fpcad.make.parts.routing import strands

Array = NDArray[np.float64]

STRANDS = tuple(
    f"{motor}_{hand}" for motor in ("m1", "m2", "m3") for hand in ("flexor", "extensor")
)
"""A finger's motor strands in the order of :func:`fpcad.make.parts.routing.strands`."""


class Pull(NamedTuple):
    """A strand that pulls at a point [mm] in a direction, each (..., 3); multiply by its tension."""

    at: Array
    direction: Array


def to_flexed(T_palm_root: Array, flexion: Array, points: Array, vectors: Array) -> Pull:
    """Points (K, 3) [mm] and vectors (K, 3) of H in the frame at the root that flexion (K,) carries.

    x along the finger, y the flexion axis, z the abduction axis.
    """
    root = Rotation.from_matrix(T_palm_root[:3, :3])
    turned = (root * Rotation.from_euler("y", flexion[:, None])).inv()
    return Pull(turned.apply(points - T_palm_root[:3, 3]), turned.apply(vectors))


def motor_pulls(d: Dimensions, T_palm_root: Array, flexion: Array) -> dict[str, Pull]:
    """How each motor strand pulls its pulley or drum, (K, 3) in the flexed frame, by name."""
    back = Rotation.from_euler("y", -flexion[:, None])
    found = {}
    for strand in strands(d, T_palm_root):
        way = strand.outside()
        along = (way[1] - way[0]) / np.linalg.norm(way[1] - way[0])
        places = (np.tile(v, (len(flexion), 1)) for v in (way[0], along))
        found[strand.name] = Pull(*(back.apply(v) for v in places))
    return found


def ip_pull(d: Dimensions, side: int) -> Pull:
    """How the IP strand of a side pulls the distal bone, (3,) in the proximal frame.

    Side 1 is the extensor (dorsal), -1 the flexor. At its other end it pulls the drum the other way.
    """
    (x0, z0), (x1, z1) = ip_tangents(d, side)
    way = np.array([x0 - x1, 0.0, z0 - z1])
    return Pull(np.array([x1, 0.0, z1]), way / np.linalg.norm(way))


def transfer_points(d: Dimensions) -> Array:
    """(2, 3) where the palmar transfer strands pass from input pulley to output pulley [mm]."""
    m = d.mcp
    return np.array([[0.0, side * m.output_radius, -m.input_radius] for side in (1, -1)])
