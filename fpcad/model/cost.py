"""Terms of the sampling cost, each as residuals whose sum of squares is the term."""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca
import numpy as np

from fpcad.model.frames import Expr
from fpcad.model.surfaces import turning_axis
from fpcad.spec.pose import JointUse, OpposedNormals, Pose, TurningNormals
from fpcad.spec.templates import TemplateNames


def cost_residuals(
    pose: Pose,
    names: TemplateNames,
    normals: Mapping[str, list[Expr]],
    u: Expr,
    rest: np.ndarray,
) -> Expr:
    """All residuals of a pose's cost.

    Args:
        pose: the pose with its cost terms.
        names: fingers and joints of the hand.
        normals: outward normals (3,) of each touching finger at its contacts, in O.
        u: joint angles (n_u,) [rad], finger by finger.
        rest: rest posture (n_joints,) [rad] of fingers without contact.
    """
    residuals = []
    for term in pose.cost:
        match term:
            case TurningNormals():
                axis = ca.DM(turning_axis(pose.turning))
                values = [ca.dot(n, axis) for finger in term.fingers for n in normals[finger]]
            case OpposedNormals():
                first, second = term.fingers
                values = [(normals[first][0] + normals[second][0]) / np.sqrt(2)]
            case JointUse():
                step = len(names.joints)
                values = [u[i] for i in range(names.joints.index(term.joint), u.numel(), step)]
        residuals += [np.sqrt(term.weight) * value for value in values]
    return ca.vertcat(*residuals, *_rest_residuals(pose, names, u, rest))


def _rest_residuals(pose: Pose, names: TemplateNames, u: Expr, rest: np.ndarray) -> list[Expr]:
    touching, step = {c.finger for c in pose.contacts}, len(names.joints)
    free = [i for i, finger in enumerate(names.fingers) if finger not in touching]
    weight = np.sqrt(pose.rest_weight)
    return [weight * (u[i * step : (i + 1) * step] - rest) for i in free]
