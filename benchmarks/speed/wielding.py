"""Paths and their torques: the own evaluation and a plain Python loop with OSQP and linprog."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

import numpy as np
import osqp
from numpy.typing import NDArray
from scipy import sparse
from scipy.optimize import linprog

from fpcad.model.pose import HAND_SIZE
from fpcad.model.statics import cone_edges
from fpcad.sample.space import design_space
from fpcad.sample.tree import Candidate
from fpcad.solve.attempt import Workbench
from fpcad.solve.qp import QpSolution, QuadraticProgram
from fpcad.spec.process import Statics
from fpcad.units import DEG_PER_RAD
from fpcad.wield.evaluate import build_load, build_mechanism, build_stepping
from fpcad.wield.integrate import advance
from fpcad.wield.load import Load
from fpcad.wield.rates import End, Mechanism
from fpcad.wield.trace import Stepping, trace

Array = NDArray[np.float64]
EDGES = cone_edges(Statics())
"""Of the friction pyramids; friction itself is in the axes."""


class WarmOsqp:
    """OSQP as one would use it in a loop: set up once, updated and warm-started from then on."""

    def __init__(self) -> None:
        self._solvers: dict[tuple[int, int], osqp.OSQP] = {}

    def __call__(self, program: QuadraticProgram) -> QpSolution | None:
        n, m = len(program.f), len(program.row_lower)
        rows = np.vstack([np.eye(n), program.A])
        low = np.concatenate([program.lower, program.row_lower])
        high = np.concatenate([program.upper, program.row_upper])
        upper_half = np.triu(np.ones((n, n)))
        if (n, m) not in self._solvers:
            solver = osqp.OSQP()
            hessian = sparse.csc_matrix(upper_half)
            hessian.data = program.H.T[upper_half.T.astype(bool)]
            dense = sparse.csc_matrix(np.ones_like(rows))
            dense.data = rows.T.ravel()
            settings = {"eps_abs": 1e-6, "eps_rel": 1e-6, "max_iter": 20_000, "polishing": True}
            solver.setup(hessian, program.f, dense, low, high, verbose=False, **settings)
            self._solvers[n, m] = solver
        else:
            solver = self._solvers[n, m]
            hessian_data = program.H.T[upper_half.T.astype(bool)]
            solver.update(Px=hessian_data, Ax=rows.T.ravel(), q=program.f, l=low, u=high)
        result = solver.solve(raise_error=False)
        solved = result.info.status == "solved"
        return QpSolution(result.x, result.y[n:]) if solved else None


@dataclass(frozen=True)
class Traced:
    """What one contender found for one direction of one pose."""

    turns: list[float]
    torques: list[float]
    seconds: float

    @property
    def range_deg(self) -> float:
        """Turn of the tool [deg]."""
        return abs(self.turns[-1]) * DEG_PER_RAD


def own_trace(bench: Workbench, candidate: Candidate, pose: str, direction: float) -> Traced:
    """The path as `fpcad evaluate` traces it."""
    mechanism, load, stepping, x = _problem(bench, candidate, pose)
    started = time.perf_counter()
    found = trace(mechanism, load, x, direction, stepping)
    seconds = time.perf_counter() - started
    states = found.states
    return Traced([s.turn for s in states], [s.torque_nmm for s in states], seconds)


def plain_trace(bench: Workbench, candidate: Candidate, pose: str, direction: float) -> Traced:
    """The same path by a Python loop: OSQP for the rates, linprog for both linear programs."""
    mechanism, load, stepping, x = _problem(bench, candidate, pose)
    mechanism = replace(mechanism, qp=WarmOsqp(), graph=None)
    started = time.perf_counter()
    turns, torques = [0.0], list[float]()
    last: tuple[float, Array, float] = (0.0, x, 0.0)
    first = _torque(mechanism, load, 0.0, x, direction)
    if first is None:
        raise ValueError(f"{pose}: candidate {candidate.id} is not held at the pose")
    torques.append(first)
    reachable, failing = 0.0, np.inf
    while abs(turns[-1]) < stepping.max_turn - 1e-9:
        length = min(stepping.step, stepping.max_turn - abs(turns[-1]))
        if np.isfinite(failing):
            length = (reachable + failing) / 2
        reached = _try(mechanism, load, turns[-1], x, direction, length)
        if reached is None:
            failing = length
        elif np.isfinite(failing):
            reachable, last = length, (turns[-1] + direction * length, *reached)
        else:
            x, torque = reached
            turns.append(turns[-1] + direction * length)
            torques.append(torque)
        if failing - reachable <= stepping.end_tolerance:
            break
    if reachable > 0:
        turns.append(last[0])
        torques.append(last[2])
    return Traced(turns, torques, time.perf_counter() - started)


def _try(
    m: Mechanism, load: Load, turn: float, x: Array, direction: float, length: float
) -> tuple[Array, float] | None:
    step = advance(m, turn, x, direction, length)
    if isinstance(step, End):
        return None
    torque = _torque(m, load, turn + direction * length, step.x, direction)
    return None if torque is None else (step.x, torque)


def _problem(
    bench: Workbench, candidate: Candidate, pose: str
) -> tuple[Mechanism, Load, Stepping, Array]:
    design = design_space(bench.spec.hand).internal(candidate.named)
    y = candidate.poses[pose].y
    mechanism = build_mechanism(bench, pose, design, y)
    load, stepping = build_load(bench.spec, pose), build_stepping(bench.spec)
    return mechanism, load, stepping, y[HAND_SIZE:]


def _torque(m: Mechanism, load: Load, turn: float, x: Array, direction: float) -> float | None:
    """Least torque by linprog; the tip force too, since the own evaluation does both."""
    axes, torques, tip = (v.copy() for v in m.kernels.statics(m.design, m.hand, turn, x))
    wrench, torque = along_edges(axes), along_edges(torques)
    pull = direction * tip
    least = highs_least_torque(wrench, torque, load.tip_force_n * pull, load.max_joint_torque_nmm)
    if least is not None:
        highs_greatest_load(
            wrench, load.motor_per_joint_torque @ torque, pull, load.motor_torque_nmm
        )
    return least


def along_edges(forces: Array) -> Array:
    """What unit forces along the cones' edges (k, n m) do, from those along their axes (k, 3n)."""
    return forces @ np.kron(np.eye(forces.shape[1] // 3), EDGES)


def highs_least_torque(wrench: Array, torque: Array, load: Array, cap: float) -> float | None:
    """The program of :func:`fpcad.model.equilibrium.least_torque` by HiGHS, along the cones' edges."""
    joints, edges = torque.shape
    column = np.ones((joints, 1))
    rows = np.vstack([np.hstack([torque, -column]), np.hstack([-torque, -column])])
    result = linprog(
        np.append(np.zeros(edges), 1.0),
        A_ub=rows,
        b_ub=np.zeros(2 * joints),
        A_eq=np.hstack([wrench, np.zeros((6, 1))]),
        b_eq=-load,
        bounds=[(0, None)] * edges + [(0, cap)],
        method="highs",
    )
    return float(result.x[-1]) if result.status == 0 else None


def highs_greatest_load(wrench: Array, torque: Array, load: Array, limit: Array) -> float:
    """The program of :func:`fpcad.model.equilibrium.greatest_load` by HiGHS, along the cones' edges."""
    motors, edges = torque.shape
    free = np.zeros((motors, 1))
    result = linprog(
        np.append(np.zeros(edges), -1.0),
        A_ub=np.vstack([np.hstack([torque, free]), np.hstack([-torque, free])]),
        b_ub=np.concatenate([limit, limit]),
        A_eq=np.hstack([wrench, load[:, None]]),
        b_eq=np.zeros(6),
        bounds=[(0, None)] * (edges + 1),
        method="highs",
    )
    return float(result.x[-1]) if result.status == 0 else 0.0
