"""What an accepted state is judged by: its own measured residual, whatever a solver claims."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fpcad.model.kernels import PoseKernels
from fpcad.model.pose import HAND_SIZE

Array = NDArray[np.float64]

POSITION_MM = 1e-6
NORMALS = 1e-8
MARGIN = -1e-6


class Residual(NamedTuple):
    """Worst deviations of one state."""

    position_mm: float
    """Largest distance between the two contact points of any contact."""
    normals: float
    """Largest |n_finger + n_tool| of any contact."""
    clearance_mm: float
    """Least gap between solids that must stay apart, and between contacts and skin edges."""
    bounds: float
    """Least distance to a bound of the state [mm, rad]; negative outside."""

    @property
    def acceptable(self) -> bool:
        """Whether the state counts as solved."""
        return (
            self.position_mm <= POSITION_MM
            and self.normals <= NORMALS
            and self.clearance_mm >= MARGIN
            and self.bounds >= MARGIN
        )


def measure(
    kernels: PoseKernels,
    design: Array,
    turn: float,
    y: Array,
    bounds: tuple[Array, Array],
) -> Residual:
    """Residual of the state y (layout.size,) with the tool at angle `turn` [rad].

    `bounds` are those of y, or of its last entries [u, a] where the hand pose is given.
    """
    six, opposition, skin, clearances = kernels.residual(design, turn, y)
    contacts = six.reshape(-1, 6)
    bounded = y if len(bounds[0]) == len(y) else y[HAND_SIZE:]
    inside = np.minimum(bounded - bounds[0], bounds[1] - bounded).min()
    least = min(clearances.min(initial=np.inf), skin.min(), opposition.min())
    return Residual(
        position_mm=float(np.linalg.norm(contacts[:, :3], axis=1).max()),
        normals=float(np.linalg.norm(contacts[:, 3:], axis=1).max()),
        clearance_mm=float(least),
        bounds=float(inside),
    )
