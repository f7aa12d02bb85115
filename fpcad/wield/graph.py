"""The whole step as one graph: rate programs, Runge-Kutta, projection, and what holds the tool.

It computes what :mod:`fpcad.wield.integrate` and :mod:`fpcad.model.equilibrium` say, without
returning to Python in between. Where one of its programs has no solution, the plain functions find
out why; they are the reference that it is tested against.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from fpcad.model.compile import Kernel
from fpcad.model.equilibrium import TORQUE_UNIT_NMM
from fpcad.model.kernels import PoseKernels
from fpcad.model.pose import HAND_SIZE

Array = NDArray[np.float64]
MX = ca.MX
Expression = Any
"""MX, or the DM of a constant."""

QP_OPTIONS = {"error_on_fail": False, "daqp": {"primal_tol": 1e-11}}
LP_OPTIONS = {
    "error_on_fail": False,
    "daqp": {"primal_tol": 1e-11, "dual_tol": 1e-14, "eps_prox": 1e-4},
}
"""A linear program is solved as a few quadratic ones, each nearest to the last one's solution."""


@dataclass(frozen=True)
class GraphSettings:
    """What a step depends on beside the state; hashable, so that a graph is built once."""

    lower: tuple[float, ...]  # (n_u + 4n,) bounds of x = [u, a]
    upper: tuple[float, ...]
    rate_weight: float
    max_joint_rate: float
    max_correction: float  # longest projection step, in scaled variables
    contact_tolerance: float  # violation [mm] up to which no further projection is needed


class GraphStep(NamedTuple):
    """Outcome of a graph's step; arrays are overwritten by the next one."""

    x: Array  # (n_u + 4n,)
    sliding: Array  # (n,) [mm]
    least_determinant: Array  # (1,) of the relative curvatures at the four stages
    violation: Array  # (1,) of rows and margins after the projection [mm]
    unmet: Array  # (1,) largest violation of a rate program's constraints [rad/s, mm/s]
    torque_nmm: Array  # (1,) least largest joint torque against the tip force
    tip_force_n: Array  # (1,) largest tip force that the motors hold
    unheld: Array  # (1,) largest violation of both programs of equilibrium [N, 10 N mm, N m]


class State(NamedTuple):
    """Where a hand is on a path."""

    d: MX  # design
    h: MX  # (6,) pose of H in O
    turn: MX  # tool angle [rad]
    x: MX  # (n_u + 4n,) state [u, a]


@cache
def step_graph(kernels: PoseKernels, settings: GraphSettings) -> Kernel:
    """(d, h, turn, x, direction, dt, *values of a Load) -> :class:`GraphStep`'s fields.

    A load's matrix goes in row by row, as one vector.
    """
    start = d, h, turn, x = _state_symbols(kernels)
    direction, dt = MX.sym("direction"), MX.sym("dt")
    n_u = kernels.layout.n_u
    load = MX.sym("force"), MX.sym("cap"), MX.sym("motors", n_u * n_u), MX.sym("limit", n_u)
    stages: list[tuple[MX, ...]] = []
    for fraction in (0.0, 0.5, 0.5, 1.0):
        at = x + fraction * dt * stages[-1][0] if stages else x
        state = State(d, h, turn + direction * fraction * dt, at)
        stages.append(_rates(kernels, settings, state, direction, dt))
    rates, sliding, determinants, unmet = zip(*stages, strict=True)
    moved = x + dt / 6 * _simpson(rates)
    end, violation = _projected(kernels, settings, State(d, h, turn + direction * dt, moved))
    outputs = [
        end.x,
        dt / 6 * _simpson(sliding),
        ca.mmin(ca.vertcat(*determinants)),
        violation,
        ca.mmax(ca.vertcat(*unmet)),
        *_held(kernels, end, direction, load),
    ]
    return Kernel(ca.Function("step", [*start, direction, dt, *load], outputs))


def _simpson(stages: tuple[MX, ...]) -> MX:
    first, second, third, last = stages
    return first + 2 * (second + third) + last


def _rates(
    kernels: PoseKernels,
    settings: GraphSettings,
    state: State,
    direction: MX,
    dt: MX,
) -> tuple[MX, MX, MX, MX]:
    """Rates of x, sliding speeds (n,), least determinant, violation.

    The program of :func:`fpcad.wield.rates.solve_rates`. CasADi hands out something for programs
    without a solution too, so the violation is measured. A lower bound above its upper one, which
    CasADi does not let a program have, is lowered and counts as violation.
    """
    bounds = ca.DM(settings.lower), ca.DM(settings.upper)
    weights = settings.rate_weight, settings.max_joint_rate
    H, f, rows, *rest, determinant = kernels.path.rate_program(
        *state, direction, dt, *bounds, *weights
    )
    low, high, row_low, row_high, *motion = rest
    solver = _solver("rate_program", ca.Sparsity.dense(*H.shape), rows.shape)
    solution = solver(h=H, g=f, a=rows, lbx=ca.fmin(low, high), ubx=high, lba=row_low, uba=row_high)
    result = kernels.path.rate_result(solution["x"], rows, low, high, row_low, row_high, *motion)
    x_rate, sliding, unmet = result
    return x_rate, sliding, determinant, unmet


def _projected(kernels: PoseKernels, settings: GraphSettings, moved: State) -> tuple[State, MX]:
    """The state after shortest Newton steps onto contact, and its violation.

    Two steps by the contact equations alone do where no margin is in the way; else two steps by
    quadratic programs that know the margins.
    """
    bounds = ca.DM(settings.lower), ca.DM(settings.upper)
    quick = moved
    for _ in range(2):
        quick = quick._replace(x=kernels.path.newton(*quick, *bounds))
    violation = kernels.path.violation(*quick)
    projection = _where_margins_are_in_the_way(kernels, settings)
    touches = violation <= settings.contact_tolerance
    x, violation = projection(touches, *moved, quick.x, violation)
    return moved._replace(x=x), violation


def _where_margins_are_in_the_way(kernels: PoseKernels, settings: GraphSettings) -> ca.Function:
    """(touches, d, h, turn, x, quick x, its violation) -> x and its violation.

    Only the branch that is taken is computed.
    """
    state = _state_symbols(kernels)
    quick, violation = MX.sym("quick", state.x.numel()), MX.sym("violation")
    given = [*state, quick, violation]
    slow = state
    for _ in range(2):
        slow = slow._replace(x=_step_with_margins(kernels, settings, slow))
    keep = ca.Function("keep", given, [quick, violation])
    replace = ca.Function("replace", given, [slow.x, kernels.path.violation(*slow)])
    return ca.Function.if_else("projected", keep, replace)


def _step_with_margins(kernels: PoseKernels, settings: GraphSettings, state: State) -> MX:
    """The state after one shortest Newton step that keeps the margins."""
    d, h, turn, moved = state
    own = slice(HAND_SIZE, kernels.layout.size)
    lower, upper = ca.DM(settings.lower), ca.DM(settings.upper)
    scale = ca.DM(kernels.layout.scale[own])
    x = ca.fmin(ca.fmax(moved, lower), upper)
    _, _, c, ct, g, gt = kernels.constraints.function(d, turn, ca.vertcat(h, x))
    rows = ca.horzcat(ct[own, :], gt[own, :]).T @ ca.diag(scale)
    longest = settings.max_correction
    solver = _solver("projection", ca.Sparsity.diag(scale.numel()), rows.shape)
    step = solver(
        h=ca.DM.eye(scale.numel()),
        g=0,
        a=rows,
        lbx=ca.fmax((lower - x) / scale, -longest),
        ubx=ca.fmin((upper - x) / scale, longest),
        lba=ca.vertcat(-c, -g),
        uba=ca.vertcat(-c, ca.DM.inf(g.numel())),
    )["x"]
    return ca.fmin(ca.fmax(x + scale * step, lower), upper)


def _held(
    kernels: PoseKernels,
    state: State,
    direction: MX,
    load: tuple[MX, MX, MX, MX],
) -> tuple[MX, MX, MX]:
    """Least joint torque [N mm], greatest tip force [N], and the programs' largest violation."""
    tip_force, cap, motors, limit = load
    joints = kernels.layout.n_u
    least, balance, greatest = kernels.path.holding(
        *state, direction, tip_force, ca.reshape(motors, joints, joints).T
    )
    forces = least.size2() - 1
    facets = least.size1() - 6 - 2 * joints
    none, unbounded = ca.DM.zeros(forces), ca.DM.inf(forces)
    torque, torque_excess = _least(
        ca.vertcat(none, 1),
        least,
        ca.vertcat(unbounded, cap / TORQUE_UNIT_NMM),
        ca.vertcat(balance, ca.DM.zeros(facets + 2 * joints)),
    )
    tip, tip_excess = _least(
        ca.vertcat(none, -1),
        greatest,
        ca.vertcat(unbounded, np.inf),
        ca.vertcat(ca.DM.zeros(6 + facets), limit / TORQUE_UNIT_NMM, limit / TORQUE_UNIT_NMM),
    )
    return torque * TORQUE_UNIT_NMM, tip, ca.fmax(torque_excess, tip_excess)


def _least(cost: Expression, rows: MX, upper: Expression, bound: Expression) -> tuple[MX, MX]:
    """Last variable of the least-cost solution of rows x <= bound, and what is violated.

    The first six rows are equations, and the last variable is not negative.
    """
    size = rows.size2()
    solver = _solver("equilibrium", ca.Sparsity(size, size), rows.shape, LP_OPTIONS)
    lower = ca.DM.zeros(size)
    lower[: size - 1] = -np.inf
    low = ca.vertcat(bound[:6], -ca.DM.inf(rows.size1() - 6))
    x = solver(g=cost, a=rows, lbx=lower, ubx=upper, lba=low, uba=bound)["x"]
    excess = rows @ x - bound
    return x[-1], ca.fmax(ca.mmax(excess), -ca.mmin(excess[:6]))


def _state_symbols(kernels: PoseKernels) -> State:
    newton = kernels.path.newton
    return State(*[MX.sym(name, newton.size1_in(i)) for i, name in enumerate(State._fields)])


def _solver(
    name: str, hessian: ca.Sparsity, rows: tuple[int, int], options: dict = QP_OPTIONS
) -> ca.Function:
    """A solver of programs of one shape, which reports failure instead of raising."""
    return ca.conic(name, "daqp", {"h": hessian, "a": ca.Sparsity.dense(*rows)}, options)
