"""The whole step as one graph: four rate programs, Runge-Kutta, and the projection onto contact.

It computes what :mod:`fpcad.wield.integrate` says, without returning to Python in between: 0.14 ms
a step against 0.5 ms. Where one of its quadratic programs has no solution, the plain functions
find out why; they are the reference that it is tested against.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from fpcad.model.compile import Kernel
from fpcad.model.contact import NORMAL_SCALE_MM
from fpcad.model.kernels import PoseKernels
from fpcad.model.pose import HAND_SIZE

Array = NDArray[np.float64]
MX = ca.MX

QP_OPTIONS = {"error_on_fail": False, "daqp": {"primal_tol": 1e-11}}


@dataclass(frozen=True)
class GraphSettings:
    """What a step depends on beside the state; hashable, so that a graph is built once."""

    lower: tuple[float, ...]  # (n_u + 4n,) bounds of x = [u, a]
    upper: tuple[float, ...]
    rate_weight: float
    max_joint_rate: float
    max_correction: float  # longest projection step, in scaled variables


class GraphStep(NamedTuple):
    """Outcome of a graph's step; arrays are overwritten by the next one."""

    x: Array  # (n_u + 4n,)
    sliding: Array  # (n,) [mm]
    least_determinant: Array  # (1,) of the relative curvatures at the four stages
    violation: Array  # (1,) of rows and margins after the projection
    unmet: Array  # (1,) largest violation of a rate program's constraints [rad/s, mm/s]


@cache
def step_graph(kernels: PoseKernels, settings: GraphSettings) -> Kernel:
    """(d, h, turn, x, direction, dt) -> :class:`GraphStep`'s fields."""
    layout = kernels.layout
    d, h = MX.sym("d", kernels.constraints.function.size1_in(0)), MX.sym("h", HAND_SIZE)
    x = MX.sym("x", layout.size - HAND_SIZE)
    turn, direction, dt = MX.sym("turn"), MX.sym("direction"), MX.sym("dt")
    rates = _rates_function(kernels, settings)
    stages: list[Any] = []
    for fraction in (0.0, 0.5, 0.5, 1.0):
        at = x + fraction * dt * stages[-1][0] if stages else x
        stages.append(rates(d, h, turn + direction * fraction * dt, at, direction, dt))
    weights = [dt / 6, dt / 3, dt / 3, dt / 6]
    moved = x + sum(w * stage[0] for w, stage in zip(weights, stages, strict=True))
    sliding = sum(w * stage[1] for w, stage in zip(weights, stages, strict=True))
    least = ca.mmin(ca.vertcat(*[stage[2] for stage in stages]))
    projected, violation = _projected(kernels, settings, (d, h, turn + direction * dt, moved))
    unmet = ca.mmax(ca.vertcat(*[stage[3] for stage in stages]))
    outputs = [projected, sliding, least, violation, unmet]
    return Kernel(ca.Function("step", [d, h, turn, x, direction, dt], outputs))


def _rates_function(kernels: PoseKernels, settings: GraphSettings) -> ca.Function:
    """(d, h, turn, x, direction, dt) -> rates of x, sliding speeds (n,), determinants (n,), unmet.

    The program of :func:`fpcad.wield.rates.solve_rates`. CasADi hands out something for programs
    without a solution too, so the violation is measured. A lower bound above its upper one, which
    CasADi does not let a program have, is lowered and counts as violation.
    """
    layout, n_u = kernels.layout, kernels.layout.n_u
    lower, upper = np.array(settings.lower), np.array(settings.upper)
    d, h = MX.sym("d", kernels.rates.function.size1_in(0)), MX.sym("h", HAND_SIZE)
    x = MX.sym("x", layout.size - HAND_SIZE)
    turn, direction, dt = MX.sym("turn"), MX.sym("direction"), MX.sym("dt")
    St, s0, Nt, n0, Ct, c0, determinants = kernels.rates.function(d, h, turn, x)
    values = kernels.constraints.function(d, turn, ca.vertcat(h, x))
    g, Jt = values[-2], values[-1]
    Jt_joints, Jt_contacts = Jt[layout.joints, :], Jt[layout.contacts, :]
    G = Jt_joints.T + Jt_contacts.T @ Ct.T
    g_turn = Jt[layout.size, :].T + Jt_contacts.T @ c0
    bounded = [i for i in range(n_u, len(lower)) if np.isfinite(lower[i])]
    rows = [i - n_u for i in bounded]
    drift = direction * c0[rows]
    low, high = lower[bounded], upper[bounded]
    row_lower = ca.vertcat(
        -direction * n0, (low - x[bounded]) / dt - drift, -g / dt - direction * g_turn
    )
    row_upper = ca.vertcat(-direction * n0, (high - x[bounded]) / dt - drift, ca.DM.inf(g.numel()))
    A = ca.vertcat(Nt.T, Ct.T[rows, :], G)
    fastest = settings.max_joint_rate
    slowest = ca.fmax((lower[:n_u] - x[:n_u]) / dt, -fastest)
    quickest = ca.fmin((upper[:n_u] - x[:n_u]) / dt, fastest)
    solver = _qp("rate_program", ca.Sparsity.dense(n_u, n_u), A.shape)
    u_rate = solver(
        h=2 * (St @ St.T + settings.rate_weight * ca.DM.eye(n_u)),
        g=2 * St @ (direction * s0),
        a=A,
        lbx=ca.fmin(slowest, quickest),
        ubx=quickest,
        lba=row_lower,
        uba=row_upper,
    )["x"]
    sliding = ca.reshape(St.T @ u_rate + direction * s0, 2, layout.n_contacts)
    speeds = ca.sqrt(ca.sum1(sliding**2)).T
    rates = ca.vertcat(u_rate, Ct.T @ u_rate + direction * c0)
    met = A @ u_rate
    excess = [row_lower - met, met - row_upper, slowest - u_rate, u_rate - quickest]
    outputs = [rates, speeds, determinants, ca.mmax(ca.vertcat(*excess))]
    return ca.Function("rates", [d, h, turn, x, direction, dt], outputs)


def _projected(
    kernels: PoseKernels, settings: GraphSettings, at: tuple[MX, MX, MX, MX]
) -> tuple[MX, MX]:
    """The state after one shortest Newton step onto contact, and its violation."""
    layout, (d, h, turn, moved) = kernels.layout, at
    own = slice(HAND_SIZE, layout.size)
    lower, upper = ca.DM(settings.lower), ca.DM(settings.upper)
    x = ca.fmin(ca.fmax(moved, lower), upper)
    scale = layout.scale[own]
    _, _, c, ct, g, gt = kernels.constraints.function(d, turn, ca.vertcat(h, x))
    A = ca.horzcat(ct[own, :], gt[own, :]).T @ np.diag(scale)
    solver = _qp("projection", ca.Sparsity.diag(len(scale)), A.shape)
    longest = settings.max_correction
    step = solver(
        h=ca.DM.eye(len(scale)),
        g=ca.DM.zeros(len(scale)),
        a=A,
        lbx=ca.fmax((lower - x) / scale, -longest),
        ubx=ca.fmin((upper - x) / scale, longest),
        lba=ca.vertcat(-c, -g),
        uba=ca.vertcat(-c, ca.DM.inf(g.numel())),
    )["x"]
    projected = ca.fmin(ca.fmax(x + scale * step, lower), upper)
    return projected, _violation(kernels, d, turn, ca.vertcat(h, projected))


def _violation(kernels: PoseKernels, d: MX, turn: MX, y: MX) -> MX:
    """Largest deviation from contact and below zero of any margin, from the cheap residual kernel."""
    six, opposition, skin, clearances = kernels.residual.function(d, turn, y)
    lengths = ca.repmat(ca.DM([1.0] * 3 + [NORMAL_SCALE_MM] * 3), kernels.layout.n_contacts, 1)
    least = ca.mmin(ca.vertcat(NORMAL_SCALE_MM * opposition, skin, clearances))
    return ca.fmax(ca.mmax(ca.fabs(six * lengths)), -least)


def _qp(name: str, hessian: ca.Sparsity, rows: tuple[int, int]) -> ca.Function:
    """A quadratic program solver that reports failure instead of raising."""
    return ca.conic(name, "daqp", {"h": hessian, "a": ca.Sparsity.dense(*rows)}, QP_OPTIONS)
