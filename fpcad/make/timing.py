"""When the tool is where: the fastest smooth law from rest to rest that limits allow.

The turn s of the tool runs over a clock angle c: s = ramp(c), with ds/dc = 0 at both ends and 1 in
between, so that a clock that runs at any pace starts and ends the motion at rest, acceleration
included. The clock's squared rate b(c) is a quadratic spline. Joint speeds are linear in sqrt(b)
and accelerations are linear in b and db/dc, so that the fastest law is a linear program.
docs/trajectories.md, "From a curve to a motion", has the equations.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.interpolate import BSpline
from scipy.optimize import linprog

from fpcad.errors import MakeError
from fpcad.make.quintic import Motion, MotionLimits
from fpcad.make.refine import ContactCurve

Array = NDArray[np.float64]

SAMPLES_PER_CELL = 8
"""Points of each cell of the clock, its ends among them, at which the program holds the limits."""
RAMP_CELLS = 2
"""Cells of the clock at each end over which a motion leaves and finds rest: one cell of turn."""
QUADRATURE_NODES = 8
"""Gauss-Legendre nodes between two instants."""


@dataclass(frozen=True)
class Ramp:
    """Turn over clock angle: slow at both ends, equal steps in between. All in rad."""

    length: float
    """Turn at the end."""
    width: float
    """Clock angle over which each end is slowed; at most `length`."""

    @property
    def end(self) -> float:
        """Clock angle at the end: each slowed end takes twice the clock for its turn."""
        return self.length + self.width

    def at(self, clock: Array) -> tuple[Array, Array, Array]:
        """Turn and its first and second derivatives by the clock, (N,) each."""
        x = np.minimum(clock, self.end - clock) / self.width
        inside = np.minimum(x, 1.0)
        low = self.width * (inside**3 - inside**4 / 2)
        late = clock > self.end / 2
        from_end = low + self.width * np.maximum(x - 1.0, 0.0)
        second = 6 * inside * (1 - inside) / self.width
        return (
            np.where(late, self.length - from_end, from_end),
            inside**2 * (3 - 2 * inside),
            np.where(late, -second, second),
        )


@dataclass(frozen=True)
class TimeLaw:
    """A leg's curve with the pace at which the clock runs along it."""

    curve: ContactCurve
    ramp: Ramp
    squared_rate: BSpline
    """(d clock / d time)^2 [rad^2/s^2] over the clock angle [rad]."""

    def at(self, clock: Array) -> Motion:
        """The motion at increasing clock angles (N,), the first of which is 0."""
        joints, first, second = over_clock(self.curve, self.ramp, clock)
        b, half_slope = self.squared_rate(clock), self.squared_rate(clock, 1) / 2
        return Motion(
            time=self._time(clock),
            turn=self.ramp.at(clock)[0],
            position=joints,
            velocity=first * np.sqrt(b)[:, None],
            acceleration=second * b[:, None] + first * half_slope[:, None],
        )

    def _time(self, clock: Array) -> Array:
        nodes, weights = np.polynomial.legendre.leggauss(QUADRATURE_NODES)
        half = np.diff(clock) / 2
        points = (clock[:-1] + half)[:, None] + half[:, None] * nodes
        spans = half * (weights / np.sqrt(self.squared_rate(points))).sum(axis=1)
        return np.concatenate([[0.0], np.cumsum(spans)])


def fastest_law(curve: ContactCurve, limits: MotionLimits, usable: Array) -> TimeLaw:
    """The fastest law of its kind from rest to rest along a curve.

    Args:
        curve: joints over the tool's turn.
        limits: of the tool and of the joints.
        usable: (clock_cells(curve),) share of the squared pace that each cell may use [-]; less
            than 1 where the motion's knots have turned out to pass a limit between them.
    """
    ramp = Ramp(curve.length, RAMP_CELLS * curve.cell)
    cells = len(usable)
    breaks = np.linspace(0.0, ramp.end, cells + 1)
    knots = np.concatenate([[0.0] * 2, breaks, [ramp.end] * 2])
    clock = np.linspace(0.0, ramp.end, cells * SAMPLES_PER_CELL + 1)
    cell = np.arange(len(clock)) / SAMPLES_PER_CELL
    before, after = np.ceil(cell).astype(int) - 1, np.floor(cell).astype(int)
    share = np.minimum(usable[np.maximum(before, 0)], usable[np.minimum(after, cells - 1)])
    coefficients = _largest_squared_rate(curve, ramp, limits, knots, clock, share)
    return TimeLaw(curve, ramp, BSpline(knots, coefficients, 2))


def clock_cells(curve: ContactCurve) -> int:
    """Number of cells of the clock along a curve."""
    return round(curve.length / curve.cell) + RAMP_CELLS


def over_clock(curve: ContactCurve, ramp: Ramp, clock: Array) -> tuple[Array, Array, Array]:
    """Joints and their derivatives by the clock angle, (N, n_joints) each. Chain rule."""
    turn, rate, bend = (column for column in ramp.at(clock))
    joints, first, second = curve.at(turn)
    return joints, first * rate[:, None], second * rate[:, None] ** 2 + first * bend[:, None]


def _largest_squared_rate(
    curve: ContactCurve, ramp: Ramp, limits: MotionLimits, knots: Array, clock: Array, share: Array
) -> Array:
    """Coefficients of the spline b: greatest sum of b at the sampled clock angles, by an LP."""
    _, first, second = over_clock(curve, ramp, clock)
    value, slope = BSpline.design_matrix(clock, knots, 2), _slope_matrix(clock, knots)
    by_joints = ((np.abs(first) / limits.joint_speed) ** 2).max(axis=1)
    ceiling = share / np.maximum(by_joints, 1 / limits.tool_speed**2)
    acceleration = sparse.vstack(
        [
            sparse.diags(second[:, j] / bound) @ value
            + sparse.diags(first[:, j] / (2 * bound)) @ slope
            for j, bound in enumerate(limits.joint_acceleration)
        ]
    )
    allowed = np.tile(share, len(limits.joint_acceleration))
    found = linprog(
        c=-np.asarray(value.sum(axis=0)).ravel(),
        A_ub=sparse.vstack([sparse.diags(1 / ceiling) @ value, acceleration, -acceleration]),
        b_ub=np.concatenate([np.ones(len(clock)), allowed, allowed]),
        bounds=(1e-6 * limits.tool_speed**2, limits.tool_speed**2),
        method="highs",
    )
    if not found.success:
        raise MakeError(f"no time law was found: {found.message}")
    return found.x


def _slope_matrix(clock: Array, knots: Array) -> sparse.csr_array:
    """Derivatives of the quadratic B-splines at the clock angles, (N, n_coefficients)."""
    count = len(knots) - 3
    return sparse.csr_array(BSpline(knots, np.eye(count), 2)(clock, 1))
