"""The transmission of a build as the firmware needs it: blocks of joints that share motors."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from fpcad.run.errors import TrajectoryError
from fpcad.run.limits import JointLimits

Array = NDArray[np.float64]

_MATRIX = re.compile(rb"^matrix:", re.MULTILINE)
_MOTOR_TYPE = re.compile(rb"^motor_type: *([A-Za-z0-9.-]+) *$", re.MULTILINE)
LARGEST_GROUP = 4
"""Joints that may share motors, as the firmware is compiled."""


@dataclass(frozen=True)
class Transmission:
    """Motor angles from joint angles: `matrix @ joint + offset`, in blocks along the diagonal."""

    matrix: Array  # (n, n)
    offset_rad: Array  # (n,)

    @property
    def group(self) -> int:
        """Size of the blocks; raises :class:`TrajectoryError` when they are too large."""
        joints = len(self.matrix)
        for size in range(1, LARGEST_GROUP + 1):
            outside = np.kron(np.eye(-(-joints // size)), np.ones((size, size)))[:joints, :joints]
            if joints % size == 0 and not self.matrix[outside == 0].any():
                return size
        raise TrajectoryError(
            f"transmission: more than {LARGEST_GROUP} joints share motors; the firmware cannot"
        )

    def blocks(self, matrix: NDArray[np.floating]) -> Array:
        """Rows (n, group) of a matrix (n, n) within its blocks."""
        size = self.group
        return np.array(
            [row[i // size * size : (i // size + 1) * size] for i, row in enumerate(matrix)]
        )


def direct(joints: int) -> Transmission:
    """One motor a joint, one to one."""
    return Transmission(np.eye(joints), np.zeros(joints))


def motor_type_of(text: bytes) -> str:
    """The motor type that the bytes of a build's `transmission.yaml` name, or an empty string."""
    found = _MOTOR_TYPE.search(text)
    return "" if found is None else found[1].decode("ascii")


def transmission_of(limits: JointLimits) -> Transmission:
    """The transmission that the limits' configuration holds; without one, one to one."""
    if _MATRIX.search(limits.configuration) is None:
        return direct(len(limits.names))
    return read_transmission(limits.configuration, limits.names)


def read_transmission(text: bytes, joint_names: tuple[str, ...]) -> Transmission:
    """Transmission out of the bytes of a build's `transmission.yaml`, for joints in that order."""
    try:
        data = YAML(typ="safe", pure=True).load(text.decode("utf-8"))
        names = list(data["joints"])
        matrix = np.array(data["matrix"], dtype=float)
        offset = np.array(data["offset_rad"], dtype=float)
    except (YAMLError, UnicodeDecodeError, KeyError, TypeError, ValueError) as error:
        raise TrajectoryError(f"transmission.yaml: cannot be read: {error}") from error
    if tuple(names) != joint_names:
        raise TrajectoryError(f"transmission.yaml: joints {names}, the URDF has {joint_names}")
    joints = len(names)
    if matrix.shape != (joints, joints) or offset.shape != (joints,):
        raise TrajectoryError(f"transmission.yaml: matrix {matrix.shape} of {joints} joints")
    if not np.isfinite(matrix).all() or not np.isfinite(offset).all():
        raise TrajectoryError("transmission.yaml: numbers must be finite")
    if np.linalg.cond(matrix) > 1e3:
        raise TrajectoryError("transmission.yaml: the motors cannot move each joint by itself")
    return Transmission(matrix, offset)
