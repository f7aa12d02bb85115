"""One pose of a hand with its paths."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.wield.load import Load
from fpcad.wield.path import WieldingPath
from fpcad.wield.rates import Mechanism
from fpcad.wield.trace import Stepping, Trace

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Wielding:
    """One pose of the first hand, traced both ways."""

    mechanism: Mechanism
    load: Load
    stepping: Stepping
    pose: Array  # state y of the pose
    traces: dict[float, Trace]
    """By direction, -1 and +1."""
    path: WieldingPath

    def y(self, x: Array) -> Array:
        """State [h, u, a] of a path's state [u, a]."""
        return np.concatenate([self.mechanism.hand, x])
