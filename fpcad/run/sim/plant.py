"""Simulated joints: inertia and friction under a position controller with a limited torque."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class JointPhysics:
    """One joint, the same for all: a finger with a geared servo behind a stiff tendon."""

    inertia_kg_m2: float = 2e-3
    """Finger and rotor, seen at the joint."""
    stiffness_nm_rad: float = 20.0
    """Position gain; with the inertia 16 Hz."""
    damping_nm_s_rad: float = 0.4
    """Velocity gain; critical."""
    viscous_nm_s_rad: float = 0.01
    coulomb_nm: float = 0.02
    torque_limit_nm: float = 2.9
    """What the motor can give at most; beyond it the joint lags."""


class Plant:
    """n joints that do not know of each other."""

    def __init__(self, position_rad: Array, physics: JointPhysics | None = None) -> None:
        self.position = np.array(position_rad, dtype=float)  # (n,) [rad]
        self.velocity = np.zeros_like(self.position)  # (n,) [rad/s]
        self.torque = np.zeros_like(self.position)  # (n,) of the motors [N m]
        self.torque_on = True
        self._physics = physics or JointPhysics()
        self._jammed = np.zeros(len(self.position), dtype=bool)

    def jam(self, joint: int) -> None:
        """Block one joint where it is."""
        self._jammed[joint] = True

    def step(self, goal_rad: Array, goal_rad_s: Array, dt_s: float, substeps: int) -> None:
        """Advance by `dt_s` towards goals (n,) that hold for the whole step."""
        dt = dt_s / substeps
        for _ in range(substeps):
            self._substep(goal_rad, goal_rad_s, dt)

    def _substep(self, goal: Array, goal_rate: Array, dt: float) -> None:
        physics = self._physics
        self.torque = np.zeros_like(self.position)
        if self.torque_on:
            wanted = physics.stiffness_nm_rad * (goal - self.position)
            wanted += physics.damping_nm_s_rad * (goal_rate - self.velocity)
            self.torque = np.clip(wanted, -physics.torque_limit_nm, physics.torque_limit_nm)
        torque = self.torque - physics.viscous_nm_s_rad * self.velocity
        free = self.velocity + torque / physics.inertia_kg_m2 * dt
        # Dry friction takes speed away but never reverses it: a joint can stick.
        braking = physics.coulomb_nm / physics.inertia_kg_m2 * dt
        self.velocity = np.sign(free) * np.maximum(np.abs(free) - braking, 0.0)
        self.velocity[self._jammed] = 0.0
        self.position = self.position + self.velocity * dt
