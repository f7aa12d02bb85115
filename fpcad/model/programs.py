"""The programs that trace a path, as formulas of one state: rates, projection, equilibrium.

Each hands out the matrices and bounds of one quadratic or linear program, contracted as far as
they can be, so that nothing is left to do between the formulas and the solver. The plain functions
of `fpcad.wield` and :mod:`fpcad.model.equilibrium` state the same programs; they are the reference.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import casadi as ca
import numpy as np

from fpcad.model.compile import dense_function
from fpcad.model.contact import NORMAL_SCALE_MM
from fpcad.model.equilibrium import BALANCE, TORQUE_UNIT_NMM
from fpcad.model.frames import Expr
from fpcad.model.pose import CONTACT_SIZE, HAND_SIZE, PoseModel, StateLayout
from fpcad.model.statics import cone_facets

BOUNDED_COORDINATES = (0, 3)
"""Coordinates of a contact that have bounds on a path: place along the tool, angle on the finger."""


def rate_program_function(model: PoseModel) -> ca.Function:
    """(d, h, turn, x, direction, dt, lower, upper, weight, fastest) -> the rate program.

    Outputs: Hessian (n_u, n_u) and gradient (n_u,); rows (m, n_u), first approach (n,), then the
    bounded contact coordinates (2 n,), then margins; lower and upper bounds of the joint rates
    (n_u,); lower and upper bounds of the rows (m,); and, affine in the joint rates, sliding
    (2n, n_u), (2n,) [mm/s] and contact rates (4n, n_u), (4n,); least determinant.
    """
    layout, n_u = model.layout, model.layout.n_u
    x, (direction, dt, weight, fastest) = _state(layout), _scalars("direction dt weight fastest")
    lower, upper = ca.SX.sym("lower", x.numel()), ca.SX.sym("upper", x.numel())
    u_rate, turn_rate = ca.SX.sym("u_rate", n_u), ca.SX.sym("turn_rate")
    motions = model.relative_motions(u_rate, turn_rate)
    contacts = model.contact_rates(motions)
    S, s0 = _affine(ca.vertcat(*[m.sliding for m in motions]), u_rate, turn_rate)
    N, n0 = _affine(ca.vertcat(*[m.approach for m in motions]), u_rate, turn_rate)
    C, c0 = _affine(
        ca.vertcat(*[ca.vertcat(c.tool, c.finger) for c in contacts]), u_rate, turn_rate
    )
    g = model.margins()
    by_contacts = ca.jacobian(g, model.a)
    G = ca.jacobian(g, model.u) + by_contacts @ C
    g0 = ca.jacobian(g, model.turn) + by_contacts @ c0
    rows = bounded_rows(layout)
    places = [n_u + row for row in rows]
    own = ca.vertcat(model.u, model.a)
    fixed, drift = -direction * n0, direction * c0[rows]
    slowest = ca.fmax((lower[:n_u] - model.u) / dt, -fastest)
    quickest = ca.fmin((upper[:n_u] - model.u) / dt, fastest)
    free = ca.DM.inf(g.numel())
    outputs = [
        2 * (S.T @ S + weight * ca.SX.eye(n_u)),
        2 * direction * (S.T @ s0),
        ca.vertcat(N, C[rows, :], G),
        ca.fmin(slowest, quickest),
        quickest,
        ca.vertcat(fixed, (lower[places] - own[places]) / dt - drift, -g / dt - direction * g0),
        ca.vertcat(fixed, (upper[places] - own[places]) / dt - drift, free),
        S,
        direction * s0,
        C,
        direction * c0,
        ca.mmin(ca.vertcat(*[c.determinant for c in contacts])),
    ]
    inputs = [model.d, model.h, model.turn, x, direction, dt, lower, upper, weight, fastest]
    return _function("rate_program", model, inputs, x, outputs)


def rate_result_function(model: PoseModel) -> ca.Function:
    """(joint rates, outputs of the rate program but Hessian and gradient) -> what they amount to.

    Outputs: rates of x (n_u + 4n,), sliding speeds (n,), largest violation of bounds and rows.
    """
    layout = model.layout
    n, n_u, m = layout.n_contacts, layout.n_u, model.margins().numel()
    count = n + len(bounded_rows(layout))
    sizes = {
        "u_rate": (n_u, 1),
        "rows": (count + m, n_u),
        "low": (n_u, 1),
        "high": (n_u, 1),
        "row_low": (count + m, 1),
        "row_high": (count + m, 1),
        "S": (2 * n, n_u),
        "s0": (2 * n, 1),
        "C": (CONTACT_SIZE * n, n_u),
        "c0": (CONTACT_SIZE * n, 1),
    }
    symbols = {name: ca.SX.sym(name, *size) for name, size in sizes.items()}
    u_rate, rows, low, high, row_low, row_high, S, s0, C, c0 = symbols.values()
    met = rows @ u_rate
    excess = [row_low - met, (met - row_high)[:count], low - u_rate, u_rate - high]
    sliding = ca.reshape(S @ u_rate + s0, 2, n)
    outputs = [
        ca.vertcat(u_rate, C @ u_rate + c0),
        ca.sqrt(ca.sum1(sliding**2)).T,
        ca.mmax(ca.vertcat(*excess)),
    ]
    return dense_function("rate_result", list(symbols.values()), outputs)


def newton_function(model: PoseModel) -> ca.Function:
    """(d, h, turn, x, lower, upper) -> x after one shortest Newton step onto contact (n_u + 4n,).

    Shortest where 10 mm count as 1 rad. Margins are left alone; what a first try moves beyond a
    bound is held in a second one. Tool and hand are held, so fingers are independent of each other.
    """
    layout, x = model.layout, _state(model.layout)
    lower, upper = ca.SX.sym("lower", x.numel()), ca.SX.sym("upper", x.numel())
    own = ca.vertcat(model.u, model.a)
    scale = ca.DM(layout.scale[HAND_SIZE:])
    rows = model.rows()
    J = ca.jacobian(rows, own) @ ca.diag(scale)
    moved, free = own, ca.SX.ones(x.numel())
    for _ in range(2):
        step = ca.SX.zeros(x.numel())
        for unknowns, equations in _by_finger(model):
            block, may_move = J[equations, unknowns], ca.diag(free[unknowns])
            solved = _solved(block @ may_move @ block.T, rows[equations])
            step[unknowns] = -may_move @ block.T @ solved
        moved = own + scale * step
        free = ca.logic_and(moved >= lower, moved <= upper)
    moved = ca.fmin(ca.fmax(moved, lower), upper)
    inputs = [model.d, model.h, model.turn, x, lower, upper]
    return _function("newton", model, inputs, x, [moved])


def violation_function(model: PoseModel) -> ca.Function:
    """(d, h, turn, x) -> largest deviation from contact, and below zero of any margin [mm]."""
    x = _state(model.layout)
    lengths = ca.DM(([1.0] * 3 + [NORMAL_SCALE_MM] * 3) * model.layout.n_contacts)
    opposition = NORMAL_SCALE_MM * model.opposition_margin()
    margins = ca.vertcat(opposition, model.skin_margin(), model.clearances())
    worst = ca.fmax(ca.mmax(ca.fabs(model.residual() * lengths)), -ca.mmin(margins))
    return _function("violation", model, [model.d, model.h, model.turn, x], x, [worst])


def holding_function(model: PoseModel) -> ca.Function:
    """(d, h, turn, x, direction, force, motors) -> both linear programs of equilibrium.

    In the forces' components instead of the cones' edges: a third of the variables. Outputs: rows
    of the least torque in [forces (3n,), torque], and its bound of balance (6,); rows of the
    greatest tip force in [forces, tip force]. Rows: balance (6), facets (n m), joint or motor
    torques (twice n_u), see :func:`holding_bounds`. `motors` (n_motors, n_u): motor torques of unit
    joint torques.
    """
    x, (direction, force) = _state(model.layout), _scalars("direction force")
    motors = ca.SX.sym("motors", model.layout.n_u, model.layout.n_u)
    forces = model.cone_axes()
    pull = direction * ca.DM(BALANCE) * model.tip_wrench()
    balance = ca.diag(ca.DM(BALANCE)) @ forces.wrench
    facets = ca.DM(np.kron(np.eye(model.layout.n_contacts), cone_facets(model.spec.statics)))
    torque = forces.torque / TORQUE_UNIT_NMM
    by_motors = motors @ torque
    bound = -ca.SX.ones(2 * model.layout.n_u)
    least = ca.horzcat(
        ca.vertcat(balance, facets, torque, -torque),
        ca.vertcat(ca.SX.zeros(6 + facets.size1()), bound),
    )
    greatest = ca.horzcat(
        ca.vertcat(balance, facets, by_motors, -by_motors),
        ca.vertcat(pull, ca.SX.zeros(facets.size1() + 2 * model.layout.n_u)),
    )
    inputs = [model.d, model.h, model.turn, x, direction, force, motors]
    return _function("holding", model, inputs, x, [least, -force * pull, greatest])


@dataclass(frozen=True, eq=False)
class PathFunctions:
    """All of them, for one pose."""

    rate_program: ca.Function
    rate_result: ca.Function
    violation: ca.Function
    newton: ca.Function
    holding: ca.Function


PATH_FUNCTIONS: dict[str, Callable[[PoseModel], ca.Function]] = {
    "rate_program": rate_program_function,
    "rate_result": rate_result_function,
    "violation": violation_function,
    "newton": newton_function,
    "holding": holding_function,
}


def bounded_rows(layout: StateLayout) -> list[int]:
    """Places of the bounded contact coordinates among all (4 n,)."""
    return [CONTACT_SIZE * i + k for i in range(layout.n_contacts) for k in BOUNDED_COORDINATES]


def _by_finger(model: PoseModel) -> Iterator[tuple[list[int], list[int]]]:
    """Places in x of each contacting finger's joints and contact coordinates, and its rows."""
    joints, names = model.layout.n_joints, model.template.names.fingers
    rows = model.rows().numel() // model.layout.n_contacts
    for finger in dict.fromkeys(contact.finger for contact in model.pose.contacts):
        own = [i for i, c in enumerate(model.pose.contacts) if c.finger == finger]
        first = names.index(finger) * joints
        unknowns = list(range(first, first + joints))
        for i in own:
            start = model.layout.n_u + CONTACT_SIZE * i
            unknowns += range(start, start + CONTACT_SIZE)
        yield unknowns, [row for i in own for row in range(rows * i, rows * (i + 1))]


def _solved(A: Expr, b: Expr) -> Expr:
    """Solution of a symmetric positive definite system by Cholesky's factors."""
    R = ca.chol(A)
    size = b.numel()
    z, x = ca.SX.zeros(size), ca.SX.zeros(size)
    for i in range(size):
        z[i] = (b[i] - ca.dot(R[:i, i], z[:i])) / R[i, i]
    for i in reversed(range(size)):
        x[i] = (z[i] - ca.dot(R[i, i + 1 :].T, x[i + 1 :])) / R[i, i]
    return x


def _affine(rates: Expr, u_rate: Expr, turn_rate: Expr) -> tuple[Expr, Expr]:
    return ca.jacobian(rates, u_rate), ca.jacobian(rates, turn_rate)


def _state(layout: StateLayout) -> ca.SX:
    return ca.SX.sym("x", layout.size - HAND_SIZE)


def _scalars(names: str) -> list[ca.SX]:
    return [ca.SX.sym(name) for name in names.split()]


def _function(
    name: str, model: PoseModel, inputs: list[ca.SX], x: ca.SX, outputs: list[ca.SX]
) -> ca.Function:
    """Outputs with the model's [u, a] put in as x."""
    n_u = model.layout.n_u
    bound = ca.substitute(outputs, [model.u, model.a], [x[:n_u], x[n_u:]])
    return dense_function(name, inputs, bound)
