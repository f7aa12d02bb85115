"""Surfaces that touch: charts with outward normals, metrics and curvatures.

Murray, Li, Sastry (1994), section 5.6.1; curvature is positive for a convex surface, that is
`dn = E K M da` for an outward normal n, tangents E, metric M and chart rates da.
"""

from __future__ import annotations

from typing import NamedTuple

import casadi as ca
import numpy as np

from fpcad.model.frames import Expr, Frame, rot_axis
from fpcad.model.hand import LinkShape
from fpcad.spec.pose import Turning
from fpcad.spec.tool import CylinderTool


class SurfacePoint(NamedTuple):
    """A point of a chart with its normalized Gauss frame; x, y of the frame are the tangents."""

    p: Expr  # (3,) [mm]
    normal: Expr  # (3,) outward
    tangents: Expr  # (3, 2) unit vectors along the two coordinates
    metric: Expr  # (2,) length per unit of each coordinate
    curvature: Expr  # (2,) principal curvatures along the tangents [1/mm]

    def moved(self, frame: Frame) -> SurfacePoint:
        """The same point seen from the parent of `frame`."""
        return self._replace(
            p=frame.point(self.p), normal=frame.R @ self.normal, tangents=frame.R @ self.tangents
        )


def cylinder_point(tool: CylinderTool, axial: Expr, angle: Expr) -> SurfacePoint:
    """Point of the tool at `axial` [mm] along x and `angle` [rad] from +y towards +z, in O."""
    c, s, rho = ca.cos(angle), ca.sin(angle), tool.radius_mm
    return SurfacePoint(
        p=ca.vertcat(axial, rho * c, rho * s),
        normal=ca.vertcat(0, c, s),
        tangents=ca.horzcat(ca.vertcat(1, 0, 0), ca.vertcat(0, -s, c)),
        metric=ca.vertcat(1, rho),
        curvature=ca.vertcat(0, 1 / rho),
    )


def capsule_point(shape: LinkShape, s: Expr, phi: Expr) -> SurfacePoint:
    """Point of a link at arc length `s` [mm] from the proximal joint and angle `phi` [rad].

    `phi` is 0 on the palmar side (-z). Beyond the cylinder the profile follows the tip's
    hemisphere, where the curvature along s jumps from 0 to 1 / radius.
    """
    r = shape.radius
    t = ca.fmax(s - shape.axis_length, 0) / r if shape.has_tip else ca.DM(0)
    along = ca.fmin(s, shape.axis_length) if shape.has_tip else s
    ct, st, cp, sp = ca.cos(t), ca.sin(t), ca.cos(phi), ca.sin(phi)
    on_tip = (s > shape.axis_length) if shape.has_tip else 0
    return SurfacePoint(
        p=ca.vertcat(along + r * st, r * ct * sp, -r * ct * cp),
        normal=ca.vertcat(st, ct * sp, -ct * cp),
        tangents=ca.horzcat(ca.vertcat(ct, -st * sp, st * cp), ca.vertcat(0, cp, sp)),
        metric=ca.vertcat(1, r * ct),
        curvature=ca.vertcat(on_tip / r, 1 / r),
    )


def turned_tool(turning: Turning, angle: Expr) -> Frame:
    """Frame of the tool in O after it turned by `angle` [rad] about its axis and pivot."""
    rotation, pivot = rot_axis(turning.axis, angle), ca.DM(turning.pivot_mm)
    return Frame(rotation, pivot - rotation @ pivot)


def turning_axis(turning: Turning) -> np.ndarray:
    """Unit vector (3,) of the turning axis in O."""
    axis = np.array(turning.axis, dtype=float)
    return axis / np.linalg.norm(axis)
