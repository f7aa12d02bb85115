"""Rotations and rigid frames, for symbols and numbers alike (CasADi SX or DM)."""

from __future__ import annotations

from typing import Any, NamedTuple

import casadi as ca

Expr = Any
"""A CasADi SX or DM expression, or a float: the model's code is the same for all."""


class Frame(NamedTuple):
    """A right-handed frame seen from another one."""

    R: Expr  # (3, 3)
    p: Expr  # (3, 1) [mm]

    def point(self, local: Expr) -> Expr:
        """A point [mm] of this frame, seen from the frame's parent."""
        return self.p + self.R @ local

    def __matmul__(self, child: Frame) -> Frame:  # type: ignore[override]
        return Frame(self.R @ child.R, self.point(child.p))


def rot_x(angle: Expr) -> Expr:
    """Right-handed rotation about x by `angle` [rad], (3, 3)."""
    c, s = ca.cos(angle), ca.sin(angle)
    return _matrix([[1, 0, 0], [0, c, -s], [0, s, c]])


def rot_y(angle: Expr) -> Expr:
    """Right-handed rotation about y by `angle` [rad], (3, 3)."""
    c, s = ca.cos(angle), ca.sin(angle)
    return _matrix([[c, 0, s], [0, 1, 0], [-s, 0, c]])


def rot_z(angle: Expr) -> Expr:
    """Right-handed rotation about z by `angle` [rad], (3, 3)."""
    c, s = ca.cos(angle), ca.sin(angle)
    return _matrix([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def rot_rpy(roll: Expr, pitch: Expr, yaw: Expr) -> Expr:
    """Rz(yaw) Ry(pitch) Rx(roll), angles in rad, (3, 3)."""
    return rot_z(yaw) @ rot_y(pitch) @ rot_x(roll)


def rot_axis(axis: tuple[float, float, float], angle: Expr) -> Expr:
    """Rotation about a constant axis of any length by `angle` [rad], (3, 3). Rodrigues' formula."""
    unit = ca.DM(axis) / ca.norm_2(ca.DM(axis))
    cross = ca.skew(unit)
    return ca.DM.eye(3) + ca.sin(angle) * cross + (1 - ca.cos(angle)) * (cross @ cross)


def _matrix(rows: list[list[Expr]]) -> Expr:
    return ca.vertcat(*[ca.horzcat(*row) for row in rows])
