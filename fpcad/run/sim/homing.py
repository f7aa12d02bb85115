"""Homing as the simulator does it: each joint in turn to both its ends, then straight again.

The simulator's joints have no motors whose zeros could be unknown; what it shows is the way that
the hand moves, how long it takes, and what the controller says meanwhile. The firmware searches.
"""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray

from fpcad.run.limits import JointLimits

Array = NDArray[np.float64]

SPEED_RAD_S = 0.5


class HomingTour:
    """Commands that lead from `start` (n,) through all ends, one joint at a time."""

    def __init__(self, limits: JointLimits, start: Array) -> None:
        self.command = np.array(start, dtype=float)
        straight = np.clip(0.0, limits.lower_rad, limits.upper_rad)
        self._ways = deque(
            (joint, float(place))
            for joint in range(len(limits.names))
            for place in (limits.lower_rad[joint], limits.upper_rad[joint], straight[joint])
        )

    @property
    def joint(self) -> int:
        """The joint that moves, or the last one when all have been moved."""
        return self._ways[0][0] if self._ways else len(self.command) - 1

    @property
    def done(self) -> bool:
        """Whether all ends have been visited."""
        return not self._ways

    def step(self, dt_s: float) -> None:
        """Advance by `dt_s`; sets `command`."""
        joint, goal = self._ways[0]
        left = goal - self.command[joint]
        way = min(abs(left), SPEED_RAD_S * dt_s)
        self.command[joint] += np.copysign(way, left)
        if way == abs(left):
            self._ways.popleft()
