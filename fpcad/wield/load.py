"""What a hand must withstand on a path, and with what."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Load:
    """The force at the tool's tip, and what joints and motors may give against it."""

    tip_force_n: float
    max_joint_torque_nmm: float
    motor_per_joint_torque: Array  # (n_motors, n_u): motor torques of unit joint torques
    motor_torque_nmm: Array  # (n_motors,) continuous torque
    cone_facets: Array  # (m, 3) sides of a contact's friction pyramid

    @cached_property
    def values(self) -> tuple[float, float, Array, Array]:
        """What a graph takes of it; the matrix row by row."""
        matrix = self.motor_per_joint_torque
        return self.tip_force_n, self.max_joint_torque_nmm, matrix.ravel(), self.motor_torque_nmm
