"""What is touched of a link: shapes in its frame, in SI units."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Capsule:
    """A collision shape in its link's frame [m]; a sphere has equal ends."""

    name: str
    start: Array  # (3,)
    end: Array  # (3,)
    radius: float


@dataclass(frozen=True)
class Cylinder:
    """A collision shape with flat ends in its link's frame [m]."""

    name: str
    start: Array  # (3,)
    end: Array  # (3,)
    radius: float


@dataclass(frozen=True)
class Cuboid:
    """A collision shape in its link's frame [m]."""

    name: str
    pose: Array  # (4, 4) of its middle
    size: Array  # (3,) along its own axes


Shape = Capsule | Cylinder | Cuboid
