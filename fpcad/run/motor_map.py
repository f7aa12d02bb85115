"""Joints to motors and back: transmission, gears, signs, and where each motor's zero lies."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fpcad.run.limits import JointLimits
from fpcad.run.transmission import Transmission

Array = NDArray[np.float64]

TURN = 2 * np.pi


@dataclass(frozen=True)
class Mounting:
    """How n motors sit on their spools: bus angle = zero + sign * ratio * spool angle."""

    zero_rad: Array  # (n,)
    sign: Array  # (n,) of 1 and -1
    ratio: Array  # (n,) turns of the motor for one of the spool

    def to_bus(self, spool_rad: Array) -> Array:
        """Angles (n,) as the motors measure them, from those of their spools."""
        return self.zero_rad + self.sign * self.ratio * spool_rad

    def to_spool(self, bus_rad: Array) -> Array:
        """Inverse of :meth:`to_bus`."""
        return self.sign * (bus_rad - self.zero_rad) / self.ratio


@dataclass(frozen=True)
class MotorMap:
    """All that stands between joint angles and what a servo bus is told."""

    joints: tuple[str, ...]
    motors: tuple[str, ...]
    transmission: Transmission
    mounting: Mounting

    def to_bus(self, joint_rad: Array) -> Array:
        """Bus angles (n,) of joint angles (n,) [rad]."""
        spools = self.transmission.matrix @ joint_rad + self.transmission.offset_rad
        return self.mounting.to_bus(spools)

    def to_joints(self, bus_rad: Array) -> Array:
        """Joint angles (n,) of bus angles (n,) [rad]."""
        spools = self.mounting.to_spool(bus_rad) - self.transmission.offset_rad
        return np.linalg.solve(self.transmission.matrix, spools).astype(np.float64)

    def spool_range(self, limits: JointLimits) -> tuple[Array, Array]:
        """Least and greatest spool angles (n,), (n,) that the joints' limits allow [rad]."""
        A, b = self.transmission.matrix, self.transmission.offset_rad
        low = np.where(A > 0, A * limits.lower_rad, A * limits.upper_rad).sum(axis=1) + b
        high = np.where(A > 0, A * limits.upper_rad, A * limits.lower_rad).sum(axis=1) + b
        return low, high

    def bus_range(self, limits: JointLimits) -> tuple[Array, Array]:
        """The same as bus angles, the least first."""
        ends = np.array([self.mounting.to_bus(end) for end in self.spool_range(limits)])
        return ends.min(axis=0), ends.max(axis=0)

    def settled(self, bus_rad: Array, limits: JointLimits) -> MotorMap:
        """The same map with zeros moved by whole turns, so that `bus_rad` (n,) lies in range.

        After power comes back a servo knows its angle only within one turn.
        """
        low, high = self.spool_range(limits)
        middle = self.mounting.to_bus((low + high) / 2)
        turns = np.rint((bus_rad - middle) / TURN)
        moved = replace(self.mounting, zero_rad=self.mounting.zero_rad + turns * TURN)
        return replace(self, mounting=moved)
