"""Coulomb statics of a held tool: wrenches and joint torques of the friction cones' edges."""

from __future__ import annotations

from typing import NamedTuple

import casadi as ca
import numpy as np

from fpcad.model.frames import Expr, Frame
from fpcad.model.surfaces import SurfacePoint, turning_axis
from fpcad.spec.pose import Turning
from fpcad.spec.process import Statics
from fpcad.spec.tool import CylinderTool


class ConeEdges(NamedTuple):
    """Effect of unit forces along the edges of all friction cones; n contacts, m facets."""

    wrench: Expr  # (6, n m): force [-] over moment about O [mm] on the tool
    torque: Expr  # (n_joints, n m): joint torque [mm] that makes the finger push so


def cone_edges(statics: Statics, tool: SurfacePoint) -> Expr:
    """Edges (3, m) of the pyramid inside the friction cone at one contact; normal part is 1.

    A finger pushes against the tool's outward normal.
    """
    angles = 2 * np.pi * np.arange(statics.cone_facets) / statics.cone_facets
    directions = ca.DM(np.vstack([np.cos(angles), np.sin(angles)]))
    normals = ca.repmat(-tool.normal, 1, statics.cone_facets)
    return normals + statics.friction * (tool.tangents @ directions)


def contact_edges(statics: Statics, tool: SurfacePoint, jacobian: Expr) -> ConeEdges:
    """Wrenches and torques of one contact's edges.

    `jacobian` (3, n_joints) [mm/rad] is that of the finger's material point, so that tau = J' f.
    """
    edges = cone_edges(statics, tool)
    return ConeEdges(ca.vertcat(edges, ca.skew(tool.p) @ edges), jacobian.T @ edges)


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
