"""Simulated motors that pull a hand's tendons: what a servo bus without hardware is made of."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.run.limits import JointLimits
from fpcad.run.transmission import Transmission

Array = NDArray[np.float64]

_STEP_S = 0.002
_LONGEST_S = 5.0
"""Time that is simulated at once at most; everything rests long before."""


@dataclass(frozen=True)
class TendonPhysics:
    """One motor and its tendons, the same for all; angles are the spool's."""

    gain_nm_rad: float = 30.0
    """Of the servo's position controller."""
    damping_nm_s_rad: float = 0.3
    """Of gear and motor; inertia is small beside it."""
    torque_nm: float = 2.94
    """Largest torque of the motor."""
    stiffness_nm_rad: float = 12.0
    """Of the tendons, when the joint is blocked."""
    slack_rad: float = 0.0
    """Angle of the spool in which the tendons of a blocked joint do not pull."""


class TendonHand:
    """n joints between end stops and n motors, coupled by the transmission."""

    def __init__(
        self,
        transmission: Transmission,
        limits: JointLimits,
        joint_rad: Array,
        physics: TendonPhysics | None = None,
    ) -> None:
        self._gears = transmission
        self._inverse = np.linalg.inv(transmission.matrix)
        self._stops = limits.lower_rad, limits.upper_rad
        self.physics = physics or TendonPhysics()
        self.spool_rad = self._spools(np.asarray(joint_rad, dtype=float))  # (n,)
        self.torque_nm = np.zeros(len(self.spool_rad))  # (n,) of the motors
        self._locked: Array | None = None

    @property
    def joint_rad(self) -> Array:
        """Where the joints are (n,) [rad]."""
        if self._locked is not None:
            return self._locked
        free = self._inverse @ (self.spool_rad - self._gears.offset_rad)
        return np.clip(free, *self._stops)

    def lock(self, locked: bool) -> None:
        """Hold all joints where they are, as a person's hand would, or let them go."""
        self._locked = self.joint_rad if locked else None

    def step(self, goal_rad: Array, torque_on: Array, share: Array, seconds: float) -> None:
        """Let motors pull towards goals (n,) of their spools with a share (n,) of their torque."""
        steps = max(round(min(seconds, _LONGEST_S) / _STEP_S), 1)
        dt = min(seconds, _LONGEST_S) / steps
        for _ in range(steps):
            self._substep(goal_rad, torque_on, share, dt)

    def _substep(self, goal: Array, on: Array, share: Array, dt: float) -> None:
        physics = self.physics
        stretch = self.spool_rad - self._spools(self.joint_rad)
        taut = np.sign(stretch) * np.maximum(np.abs(stretch) - physics.slack_rad, 0.0)
        limit = physics.torque_nm * share
        wanted = physics.gain_nm_rad * (goal - self.spool_rad)
        self.torque_nm = np.where(on, np.minimum(np.maximum(wanted, -limit), limit), 0.0)
        rate = (self.torque_nm - physics.stiffness_nm_rad * taut) / physics.damping_nm_s_rad
        self.spool_rad = self.spool_rad + rate * dt

    def _spools(self, joint_rad: Array) -> Array:
        return self._gears.matrix @ joint_rad + self._gears.offset_rad
