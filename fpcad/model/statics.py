"""Coulomb statics of a held tool: wrenches and joint torques of forces in the friction cones."""

from __future__ import annotations

from typing import NamedTuple

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from fpcad.model.frames import Expr, Frame
from fpcad.model.surfaces import SurfacePoint, turning_axis
from fpcad.spec.pose import Turning
from fpcad.spec.process import Statics
from fpcad.spec.tool import CylinderTool

Array = NDArray[np.float64]


class UnitForces(NamedTuple):
    """Effect of unit contact forces along k directions."""

    wrench: Expr  # (6, k): force [-] over moment about O [mm] on the tool
    torque: Expr  # (n_joints, k): joint torque [mm] that makes the finger push so


def cone_axes(statics: Statics, tool: SurfacePoint) -> Expr:
    """Directions (3, 3) of one contact's force: normal, and friction along both tangents.

    A finger pushes against the tool's outward normal. Friction counts in units of its coefficient,
    so that the cone is the unit circle about a normal part of 1.
    """
    return ca.horzcat(-tool.normal, statics.friction * tool.tangents)


def cone_edges(statics: Statics) -> Array:
    """Edges (3, m), in :func:`cone_axes`, of the pyramid inside the friction cone."""
    angles = 2 * np.pi * np.arange(statics.cone_facets) / statics.cone_facets
    return np.vstack([np.ones_like(angles), np.cos(angles), np.sin(angles)])


def cone_facets(statics: Statics) -> Array:
    """Rows (m, 3) that are <= 0 for a force, in :func:`cone_axes`, inside that pyramid."""
    middles = 2 * np.pi * (np.arange(statics.cone_facets) + 0.5) / statics.cone_facets
    apothem = np.full(statics.cone_facets, np.cos(np.pi / statics.cone_facets))
    return np.column_stack([-apothem, np.cos(middles), np.sin(middles)])


def unit_forces(directions: Expr, tool: SurfacePoint, jacobian: Expr) -> UnitForces:
    """Wrenches and torques of unit forces along directions (3, k) at one contact.

    `jacobian` (3, n_joints) [mm/rad] is that of the finger's material point, so that tau = J' f.
    """
    moments = ca.skew(tool.p) @ directions
    return UnitForces(ca.vertcat(directions, moments), jacobian.T @ directions)


def tip_wrench(tool: CylinderTool, turning: Turning, turned: Frame) -> Expr:
    """Wrench (6,) on the tool of a unit force at its tip against a positive turning.

    The force has direction -unit(omega x (tip - pivot)) and turns with the tool. A tip on the
    turning axis, which such a force cannot resist, is a fault of the spec.
    """
    axis = turning_axis(turning)
    arm = np.array([tool.tip_mm, 0.0, 0.0]) - np.array(turning.pivot_mm)
    sweep = np.cross(axis, arm)
    force = turned.R @ ca.DM(-sweep / np.linalg.norm(sweep))
    tip = turned.point(ca.DM([tool.tip_mm, 0, 0]))
    return ca.vertcat(force, ca.cross(tip, force))
