"""A MuJoCo model as numbers to compare with: places, masses, limits and what its motors can do."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fpcad.check_description.check import NotApplicableError
from fpcad.check_description.urdf import UnreadableError

Array = NDArray[np.float64]


class Simulated:
    """A compiled MJCF."""

    def __init__(self, file: Path) -> None:
        self._mujoco = _mujoco()
        self.file = file
        try:
            self.model: Any = self._mujoco.MjModel.from_xml_path(str(file))
        except ValueError as error:
            raise UnreadableError(f"{file.name}: MuJoCo refuses it: {error}") from error
        self._data = self._mujoco.MjData(self.model)

    @cached_property
    def joints(self) -> dict[str, Any]:
        """Hinges and slides by name."""
        mine = (self.model.joint(i) for i in range(self.model.njnt))
        return {j.name: j for j in mine if self.model.jnt_type[j.id] >= 2}

    @cached_property
    def bodies(self) -> dict[str, Any]:
        """Bodies by name."""
        return {b.name: b for b in (self.model.body(i) for i in range(1, self.model.nbody))}

    def poses(self, joints: Mapping[str, float]) -> dict[str, Array]:
        """Pose (4, 4) of each body in the world [m]."""
        self._place(joints)
        poses = {}
        for name, body in self.bodies.items():
            poses[name] = np.eye(4)
            poses[name][:3, :3] = self._data.xmat[body.id].reshape(3, 3)
            poses[name][:3, 3] = self._data.xpos[body.id]
        return poses

    def inertia(self, body: str) -> Array:
        """Inertia (3, 3) [kg m^2] of a body about its centre, along its axes."""
        own, turn = self.bodies[body], np.zeros(9)
        self._mujoco.mju_quat2Mat(turn, own.iquat)
        R = turn.reshape(3, 3)
        return R @ np.diag(own.inertia) @ R.T

    def motor_names(self) -> list[str]:
        """Actuators in order."""
        return [self.model.actuator(i).name for i in range(self.model.nu)]

    def motor_matrix(self, joints: Sequence[str]) -> Array:
        """(n_motors, n_joints) travel of each motor for each joint's travel, all linear."""
        columns = []
        for name in joints:
            self._place({name: 1.0})
            travel = self._data.actuator_length.copy()
            self._place({name: 0.0})
            columns.append(travel - self._data.actuator_length)
        return np.column_stack(columns)

    def motor_torques(self) -> Array:
        """(n_motors,) largest torque of each motor; infinite where nothing limits it."""
        limited = self.model.actuator_forcelimited.astype(bool)
        return np.where(limited, np.abs(self.model.actuator_forcerange).min(axis=1), np.inf)

    def _place(self, joints: Mapping[str, float]) -> None:
        for name, value in joints.items():
            self._data.qpos[self.joints[name].qposadr[0]] = value
        self._mujoco.mj_fwdPosition(self.model, self._data)


def _mujoco() -> ModuleType:
    try:
        import mujoco
    except ModuleNotFoundError as error:
        raise NotApplicableError(f"needs `pip install fpcad[physics]`: no {error.name}") from error
    return mujoco
