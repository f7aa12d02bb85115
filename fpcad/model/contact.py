"""Contact between tool and finger: constraint rows, relative motion, rolling and sliding."""

from __future__ import annotations

from typing import NamedTuple

import casadi as ca

from fpcad.model.frames import Expr
from fpcad.model.surfaces import SurfacePoint

NORMAL_SCALE_MM = 10.0
"""Length that one unit of a normal's deviation counts as in the rows that solvers see."""


class RelativeMotion(NamedTuple):
    """Motion of the finger's material relative to the tool's, at one contact, tool's tangents."""

    sliding: Expr  # (2,) tangential velocity [mm/s]
    approach: Expr  # scalar velocity along the tool's outward normal [mm/s]
    rolling: Expr  # (2,) tangential part of omega x n_tool [rad/s]


class ContactRates(NamedTuple):
    """How the contact point moves on both charts."""

    tool: Expr  # (2,) [mm/s, rad/s]
    finger: Expr  # (2,) [mm/s, rad/s]
    determinant: Expr  # of the relative curvature, times the product of the radii of curvature


def contact_rows(tool: SurfacePoint, finger: SurfacePoint) -> Expr:
    """Five independent rows (5,) [mm] that vanish in contact.

    Points coincide (3), and the finger's normal has no component along the tool's tangents (2,
    times NORMAL_SCALE_MM). The wrong branch, normals alike, is excluded by :func:`opposition`.
    """
    return ca.vertcat(finger.p - tool.p, NORMAL_SCALE_MM * (tool.tangents.T @ finger.normal))


def contact_residual(tool: SurfacePoint, finger: SurfacePoint) -> Expr:
    """The paper's six equations (6,), eq. 1: point difference [mm] and sum of unit normals [-]."""
    return ca.vertcat(finger.p - tool.p, finger.normal + tool.normal)


def opposition(tool: SurfacePoint, finger: SurfacePoint) -> Expr:
    """-(n_finger . n_tool) [-]: 1 in contact, -1 on the wrong branch."""
    return -ca.dot(finger.normal, tool.normal)


def contact_rates(tool: SurfacePoint, finger: SurfacePoint, motion: RelativeMotion) -> ContactRates:
    """Montana's first two equations of contact, for outward normals.

    With xi = M da on each surface: xi_t - R xi_f = v (both material points follow the contact)
    and K_t xi_t + R K_f xi_f = w (normals stay opposed), R = E_t' E_f. Hence
    (R' K_t R + K_f) xi_f = R' (w - K_t v). Montana (1988), eqs. 18-19; Murray, Li, Sastry (1994),
    eq. 5.28.
    """
    R = tool.tangents.T @ finger.tangents
    K_t, K_f = ca.diag(tool.curvature), ca.diag(finger.curvature)
    relative = R.T @ K_t @ R + K_f
    determinant = relative[0, 0] * relative[1, 1] - relative[0, 1] * relative[1, 0]
    adjugate = ca.vertcat(
        ca.horzcat(relative[1, 1], -relative[0, 1]), ca.horzcat(-relative[1, 0], relative[0, 0])
    )
    xi_f = adjugate @ (R.T @ (motion.rolling - K_t @ motion.sliding)) / determinant
    xi_t = motion.sliding + R @ xi_f
    scale = tool.curvature[1] * finger.curvature[1]
    return ContactRates(xi_t / tool.metric, xi_f / finger.metric, determinant / scale)
