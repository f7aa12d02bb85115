"""Programs that others wrote and that read the hand: what each makes of a posture.

Poses are (4, 4) in `palm` [m], by link; joints are given by name [rad].
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports]
import yourdfpy
from numpy.typing import NDArray

from tests.make.description.engine import mujoco

Array = NDArray[np.float64]
Poses = dict[str, Array]


class Yourdfpy:
    """A URDF read by yourdfpy."""

    def __init__(self, urdf: Path) -> None:
        self.robot = yourdfpy.URDF.load(str(urdf), load_meshes=False)
        bodies = [link.inertial for link in self.robot.robot.links if link.inertial]
        self.mass = sum(body.mass or 0.0 for body in bodies)

    def poses(self, joints: Mapping[str, float]) -> Poses:
        self.robot.update_cfg(joints)
        return {link: self.robot.get_transform(link, "palm") for link in self.robot.link_map}


class Pinocchio:
    """A URDF read by pinocchio."""

    def __init__(self, urdf: Path) -> None:
        self.model = pin.buildModelFromUrdf(str(urdf))
        self.data = self.model.createData()
        self.mass = sum(body.mass for body in self.model.inertias)  # the first is the fixed palm

    def position(self, joints: Mapping[str, float]) -> Array:
        q = np.zeros(self.model.nq)
        for name, angle in joints.items():
            q[self.model.joints[self.model.getJointId(name)].idx_q] = angle
        return q

    def poses(self, joints: Mapping[str, float]) -> Poses:
        pin.framesForwardKinematics(self.model, self.data, self.position(joints))
        bodies = (f for f in self.model.frames if f.type == pin.FrameType.BODY)
        return {f.name: self.data.oMf[self.model.getFrameId(f.name)].homogeneous for f in bodies}

    def inertia(self, joints: Mapping[str, float]) -> Array:
        """Joint-space inertia (n, n), its rows and columns in the order of `joints`."""
        matrix = np.array(pin.crba(self.model, self.data, self.position(joints)))
        matrix = np.triu(matrix) + np.triu(matrix, 1).T
        columns = [self.model.joints[self.model.getJointId(name)].idx_v for name in joints]
        return matrix[np.ix_(columns, columns)]


class Mujoco:
    """An MJCF or URDF read by MuJoCo."""

    def __init__(self, file: Path) -> None:
        spec = mujoco.MjSpec.from_file(str(file))
        spec.compiler.fusestatic = False  # else a URDF's palm becomes a part of the world
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self.mass = float(np.sum(self.model.body_mass))

    def poses(self, joints: Mapping[str, float]) -> Poses:
        self._place(joints)
        poses = {}
        for i in range(1, self.model.nbody):
            pose = np.eye(4)
            pose[:3, :3], pose[:3, 3] = self.data.xmat[i].reshape(3, 3), self.data.xpos[i]
            poses[self.model.body(i).name] = pose
        return poses

    def inertia(self, joints: Mapping[str, float]) -> Array:
        """Joint-space inertia (n, n) without the motors', in the order of `joints`."""
        self.model.tendon_armature[:] = 0.0
        self._place(joints)
        mujoco.mj_makeM(self.model, self.data)
        matrix = np.zeros((self.model.nv, self.model.nv))
        mujoco.mj_fullM(self.model, self.data, matrix)
        columns = [self.model.joint(name).dofadr[0] for name in joints]
        return matrix[np.ix_(columns, columns)]

    def _place(self, joints: Mapping[str, float]) -> None:
        for name, angle in joints.items():
            self.data.qpos[self.model.joint(name).qposadr[0]] = angle
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)
