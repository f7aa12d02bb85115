"""How far each finger flexes before the palm's parts stop it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from fpcad.make.mesh import INTERFERENCE_MM3, common_volume_mm3
from fpcad.make.parts.part import Part
from fpcad.model.geometry import HandGeometry
from fpcad.units import RAD_PER_DEG

STEP_RAD = 5.0 * RAD_PER_DEG


def mcp_pose(flexion: float, abduction: float) -> NDArray[np.float64]:
    """Pose (4, 4) of the proximal link in its root's frame: Ry(flexion) Rz(abduction) [rad]."""
    cf, sf, ca, sa = np.cos(flexion), np.sin(flexion), np.cos(abduction), np.sin(abduction)
    pose = np.eye(4)
    pose[:3, :3] = np.array([[cf, 0, sf], [0, 1, 0], [-sf, 0, cf]]) @ np.array(
        [[ca, -sa, 0], [sa, ca, 0], [0, 0, 1]]
    )
    return pose


def flexion_reach(
    parts: Sequence[Part], geometry: HandGeometry, limits: tuple[float, float]
) -> dict[str, tuple[float, float]]:
    """Range [rad] of pure MCP flexion that the printed palm leaves each finger, in 5 deg steps.

    The palm is cut free for the whole range of `limits`, except for its roof and for other
    fingers' roots, so a finger that would pass through those stops there.
    """
    palm = next(part.mesh for part in parts if part.link == "palm")
    links = [part.mesh for part in parts if part.link == "proximal"]

    def is_free(finger: str, flexion: float) -> bool:
        pose = geometry.T_palm_root[finger] @ mcp_pose(flexion, 0.0)
        moved = (link.copy().apply_transform(pose) for link in links)
        return all(common_volume_mm3(palm, link) <= INTERFERENCE_MM3 for link in moved)

    return {
        finger: (
            _last_free(partial(is_free, finger), limits[0]),
            _last_free(partial(is_free, finger), limits[1]),
        )
        for finger in geometry.fingers
    }


def _last_free(is_free: Callable[[float], bool], end: float) -> float:
    last = 0.0
    for flexion in np.linspace(0.0, end, 1 + math.ceil(abs(end) / STEP_RAD)):
        if not is_free(float(flexion)):
            break
        last = float(flexion)
    return last
