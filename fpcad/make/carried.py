"""Where a tool is in a hand, and where fingers that are a little wrong carry it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fpcad.spec.pose import Turning
from fpcad.spec.tool import CylinderTool

Array = NDArray[np.float64]


def tool_ends(
    tool: CylinderTool, turning: Turning, hands: Array, angles: Array
) -> tuple[Array, Array]:
    """Both ends (N, 3) [mm] in H of the tool turned by angles (N,), for poses (N, 6) of H in O."""
    R, origin = tool_frames(turning, hands, angles)
    return origin + tool.back_mm * R[:, :, 0], origin + tool.tip_mm * R[:, :, 0]


def tool_frames(turning: Turning, hands: Array, angles: Array) -> tuple[Array, Array]:
    """Rotations (N, 3, 3) and origins (N, 3) [mm] in H of O turned by angles (N,)."""
    axis = np.array(turning.axis) / np.linalg.norm(turning.axis)
    pivot = np.array(turning.pivot_mm)
    turn = Rotation.from_rotvec(np.multiply.outer(angles, axis))
    R_palm_o = Rotation.from_euler("ZYX", hands[:, [5, 4, 3]]).inv()
    origin = R_palm_o.apply(pivot - turn.apply(pivot) - hands[:, :3])
    return (R_palm_o * turn).as_matrix(), origin


def registered(points: Array, moved: Array) -> tuple[Array, Array]:
    """The rigid motions (N, 3, 3), (N, 3) that bring points (N, n, 3) nearest to moved ones (Kabsch)."""
    centre, aim = points.mean(axis=1), moved.mean(axis=1)
    covariance = np.einsum("nki,nkj->nij", points - centre[:, None], moved - aim[:, None])
    U, _, Vt = np.linalg.svd(covariance)
    sign = np.linalg.det(U @ Vt)
    flip = np.stack([np.ones_like(sign), np.ones_like(sign), sign], axis=1)
    R = np.einsum("nji,nj,nkj->nik", Vt, flip, U)
    return R, aim - np.einsum("nij,nj->ni", R, centre)


def moved_hands(hands: Array, R: Array, p: Array) -> Array:
    """Poses (N, 6) of H in O after the tool was moved in H by rotations R and shifts p [mm]."""
    turned = Rotation.from_euler("ZYX", hands[:, [5, 4, 3]]) * Rotation.from_matrix(R).inv()
    angles = turned.as_euler("ZYX")
    return np.hstack([hands[:, :3] - turned.apply(p), angles[:, ::-1]])
