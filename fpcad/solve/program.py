"""Nonlinear least-squares programs with equations and margins: stated here, solved elsewhere."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fpcad.model.hand import hand_template
from fpcad.model.kernels import PoseKernels
from fpcad.model.pose import CONTACT_SIZE, HAND_SIZE, StateLayout
from fpcad.spec.schema import Spec
from fpcad.units import RAD_PER_DEG

Array = NDArray[np.float64]


class Linearization(NamedTuple):
    """Values and Jacobians at one point; arrays may be overwritten by the next evaluation."""

    residuals: Array  # (n_r,)
    residuals_jacobian: Array  # (n_r, n)
    rows: Array  # (n_c,) = 0
    rows_jacobian: Array  # (n_c, n)
    margins: Array  # (n_g,) >= 0
    margins_jacobian: Array  # (n_g, n)


@dataclass(frozen=True)
class Program:
    """minimize |residuals(y)|^2  subject to  rows(y) = 0, margins(y) >= 0, lower <= y <= upper."""

    evaluate: Callable[[Array], Linearization]
    lower: Array  # (n,)
    upper: Array  # (n,)
    scale: Array  # (n,) size of a unit step in each variable


class SolveResult(NamedTuple):
    """Where a solver ended; what it claims is to be measured."""

    y: Array  # (n,)
    cost: float
    violation: float  # largest violation of rows and margins
    iterations: int
    converged: bool


def build_pose_program(spec: Spec, pose: str, kernels: PoseKernels, design: Array) -> Program:
    """The program whose solution is a pose of one hand: least sampling cost in contact.

    Args:
        design: (n_d,) [mm, rad].
    """

    def evaluate(y: Array) -> Linearization:
        values = kernels.constraints(design, 0.0, y)
        return Linearization(*_in_columns(values, slice(0, kernels.layout.size)))

    lower, upper = pose_bounds(spec, pose, kernels.layout)
    return Program(evaluate, lower, upper, kernels.layout.scale)


def build_projection_program(
    kernels: PoseKernels,
    bounds: tuple[Array, Array],
    design: Array,
    hand: Array,
    turn: float,
) -> Program:
    """The program whose feasible states x = [u, a] are in contact at a tool angle [rad].

    Hand pose (6,) and tool angle stay. It has no cost: the state nearest to a guess is what
    :func:`fpcad.solve.sqp.restore` finds; 10 mm count as 1 rad.
    """
    own = slice(HAND_SIZE, kernels.layout.size)
    no_cost = np.zeros(0), np.zeros((0, own.stop - own.start))

    def evaluate(x: Array) -> Linearization:
        values = kernels.constraints(design, turn, np.concatenate([hand, x]))
        return Linearization(*no_cost, *_in_columns(values[2:], own))

    return Program(evaluate, *bounds, kernels.layout.scale[own])


def pose_bounds(spec: Spec, pose: str, layout: StateLayout) -> tuple[Array, Array]:
    """Bounds (layout.size,) on the state y at a pose [mm, rad]; contact windows among them."""
    windows = [[c.axial_mm, np.array(c.angle_deg) * RAD_PER_DEG] for c in spec.poses[pose].contacts]
    finger = spec.bounds.finger_angle_deg * RAD_PER_DEG
    position, rotation = spec.bounds.hand_position_mm, spec.bounds.hand_rotation_deg * RAD_PER_DEG
    hand = np.array([position] * 3 + [rotation] * 3)
    joints, contacts = _joint_bounds(spec), _contact_bounds(windows, finger)
    lower = np.concatenate([-hand, joints[:, 0], contacts[:, 0]])
    return lower, np.concatenate([hand, joints[:, 1], contacts[:, 1]])


def path_bounds(spec: Spec, pose: str, layout: StateLayout) -> tuple[Array, Array]:
    """Bounds (n_u + 4 n,) on the state x = [u, a] on a path [mm, rad]; windows no longer hold."""
    anywhere = [(spec.tool.back_mm, spec.tool.tip_mm), (-np.inf, np.inf)]
    finger = spec.bounds.path_finger_angle_deg * RAD_PER_DEG
    contacts = _contact_bounds([anywhere] * layout.n_contacts, finger)
    joints = _joint_bounds(spec)
    both = np.concatenate([joints, contacts])
    return both[:, 0], both[:, 1]


def _in_columns(values: tuple[Array, ...], columns: slice) -> list[Array]:
    """Values, and of the Jacobian that follows each the columns of some variables."""
    return [v if v.ndim == 1 else v[:, columns] for v in values]


def _joint_bounds(spec: Spec) -> Array:
    names = hand_template(spec.hand).names
    one = np.array([spec.hand.joint_limits_deg[joint] for joint in names.joints])
    return np.tile(one, (len(names.fingers), 1)) * RAD_PER_DEG


def _contact_bounds(windows: list, finger_angle: float) -> Array:
    """(4 n, 2); the arc length is bounded by the skin margins, which depend on the design."""
    bounds = [
        [axial, angle, (-np.inf, np.inf), (-finger_angle, finger_angle)] for axial, angle in windows
    ]
    return np.array(bounds).reshape(CONTACT_SIZE * len(windows), 2)
