"""How far a grip is from slipping: as planned, with forces off by a third, under a tip force."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.make.preload.stiffness import HandStiffness, contact_stiffness, grasp_stiffness
from fpcad.make.preload.touch import FORCE_AXES, Touch

Array = NDArray[np.float64]

FORCE_ERROR = 0.3
"""Error [-] of each finger's force that the slip margin is told for, in either direction."""
LEVER_MM = 30.0
"""Lever at which the grip's turning stiffness counts beside its other stiffness."""


@dataclass(frozen=True)
class Margins:
    """The worst of a trajectory's states. Forces in N."""

    least_normal_n: float
    cone_share: float
    """Largest share of the friction cone that a planned force uses [-]; more than 1 slips."""
    slip_margin_n: float
    """Least friction that is left at a contact, as planned; negative where it slips."""
    slip_margin_with_error_n: float
    """The same when each finger's force is off by FORCE_ERROR, in the worst of all combinations."""
    motor_share: float
    """Largest share of the motors' continuous torque [-]."""
    least_stiffness_n_mm: float
    """Least stiffness of the grip; negative where the tool would snap away."""
    tip_force_n: float
    """Tip force that no contact slips under, on linear stiffness, against the worse direction."""


def slip_margin(forces: Array, friction: float) -> Array:
    """Friction left (..., n) [N] at contacts with forces (..., 3n): mu f_n - |f_t|."""
    normal, along, around = np.moveaxis(forces.reshape(*forces.shape[:-1], -1, FORCE_AXES), -1, 0)
    return friction * normal - np.hypot(along, around)


def cone_share(forces: Array, friction: float) -> Array:
    """Share (..., n) of the friction cone that forces (..., 3n) use [-]."""
    normal, along, around = np.moveaxis(forces.reshape(*forces.shape[:-1], -1, FORCE_AXES), -1, 0)
    return np.hypot(along, around) / (friction * normal)


def with_errors(touch: Touch, stiffness: HandStiffness, forces: Array) -> Array:
    """(2^n, N, 3n) what becomes of forces (N, 3n) [N] when fingers push too hard or too softly.

    The tool moves until it is in balance again, and the contacts' stiffness shares that out.
    """
    contacts = touch.points_mm.shape[1]
    signs = np.array(list(itertools.product((-1.0, 1.0), repeat=contacts)))
    wrong = FORCE_ERROR * np.repeat(signs, FORCE_AXES, axis=1)[:, None] * forces
    unbalanced = np.einsum("kij,skj->ski", touch.grasp_map, wrong)
    return forces + wrong + shared_out(touch, stiffness, unbalanced)


def shared_out(touch: Touch, stiffness: HandStiffness, wrench: Array) -> Array:
    """Changes (..., N, 3n) of contact forces [N] that balance wrenches (..., N, 6) on the tool."""
    grasp, contact = touch.grasp_map, contact_stiffness(touch, stiffness)
    elastic = grasp @ contact @ np.swapaxes(grasp, 1, 2)
    moved = np.linalg.solve(elastic, wrench[..., None])
    return -(contact @ np.swapaxes(grasp, 1, 2) @ moved)[..., 0]


def least_stiffness(touch: Touch, stiffness: HandStiffness, forces: Array | None) -> Array:
    """Least eigenvalue (N,) [N/mm] of the grip's stiffness, turns counted at LEVER_MM.

    Forces (N, 3n) [N] count with the stiffness that they take away; None leaves them out.
    """
    units = np.repeat([1.0, LEVER_MM], 3)
    scaled = grasp_stiffness(touch, stiffness, forces) / np.multiply.outer(units, units)
    return np.asarray(np.linalg.eigvalsh(scaled)[:, 0], dtype=np.float64)


def load_until_slip(forces: Array, change: Array, friction: float) -> Array:
    """Largest factor (N,) on changes (N, 3n) of forces (N, 3n) at which no contact slips yet.

    The root of |f_t + c d_t| = mu (f_n + c d_n), the least positive one of all contacts; 0 where
    a contact slips before any load.
    """
    f = np.moveaxis(forces.reshape(len(forces), -1, FORCE_AXES), -1, 0)
    d = np.moveaxis(change.reshape(len(change), -1, FORCE_AXES), -1, 0)
    a = d[1] ** 2 + d[2] ** 2 - (friction * d[0]) ** 2
    b = 2 * (f[1] * d[1] + f[2] * d[2] - friction**2 * f[0] * d[0])
    c = f[1] ** 2 + f[2] ** 2 - (friction * f[0]) ** 2
    squared = b * b - 4 * a * c
    root = np.sqrt(np.maximum(squared, 0.0))
    # c < 0 inside the cone: the first root is 2c / (-b - root), free of cancellation and of a = 0.
    below = -b - root
    with np.errstate(divide="ignore", invalid="ignore"):
        factor = np.where((squared >= 0.0) & (below < 0.0), 2 * c / below, np.inf)
    return np.where(c >= 0.0, 0.0, factor).min(axis=1)
