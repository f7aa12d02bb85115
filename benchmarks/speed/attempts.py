"""Attempting all poses of a new hand: the own solver, IPOPT and SLSQP on the same tasks.

IPOPT gets compiled exact derivatives, the parent's state to start from, and the fastest of ten
settings that were tried: the adaptive barrier. A monotone one with and without warm start, other
pushes off the bounds and relaxed bounds took longer; see docs/performance.md. SLSQP (SciPy) gets the
same compiled first derivatives as the own solver. All results are measured by the same residual
kernel and count only where it accepts them.
"""

from __future__ import annotations

import subprocess
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import casadi as ca
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from benchmarks.speed.tasks import PoseTask
from fpcad.model.compile import COMPILER_FLAGS, cache_key, compiler
from fpcad.model.pose import PoseModel
from fpcad.solve.attempt import Workbench, solve_pose
from fpcad.solve.measure import measure
from fpcad.solve.program import build_pose_program, pose_bounds

Array = NDArray[np.float64]
Solver = Callable[[PoseTask], Array]

IPOPT_OPTIONS = {
    "print_time": False,
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "ipopt.tol": 1e-8,
    "ipopt.constr_viol_tol": 1e-9,
    "ipopt.acceptable_iter": 5,
    "ipopt.acceptable_tol": 1e-5,
    "ipopt.acceptable_constr_viol_tol": 1e-9,
    "ipopt.bound_relax_factor": 0.0,
    "ipopt.mu_strategy": "adaptive",
    "ipopt.max_iter": 300,
}


@dataclass
class Contender:
    """A solver with what it achieved."""

    name: str
    solve: Solver
    seconds: list[float] = field(default_factory=list)
    """Time of each call, all of its poses."""
    costs: dict[str, list[float]] = field(default_factory=dict)
    """Cost of each accepted pose; NaN where it was not accepted."""

    def run(self, bench: Workbench, call: list[PoseTask]) -> None:
        """Solve all poses of one RRT call."""
        started = time.perf_counter()
        states = [self.solve(task) for task in call]
        self.seconds.append(time.perf_counter() - started)
        for task, y in zip(call, states, strict=True):
            self.costs.setdefault(task.pose, []).append(_accepted_cost(bench, task, y))

    def success(self) -> float:
        """Share of accepted poses."""
        return float(np.mean([np.isfinite(c) for costs in self.costs.values() for c in costs]))


def contenders(bench: Workbench, cache: Path) -> list[Contender]:
    """The own solver first, then its baselines."""
    ipopt = {pose: _compiled_ipopt(bench, pose, cache) for pose in bench.spec.poses}

    def own(task: PoseTask) -> Array:
        solved = solve_pose(bench, task.pose, task.design, task.start)
        return np.full_like(task.start, np.nan) if solved is None else solved.y

    def by_ipopt(task: PoseTask) -> Array:
        solver, size = ipopt[task.pose]
        lower, upper = pose_bounds(bench.spec, task.pose, bench.kernels[task.pose].layout)
        n_rows, n_margins = size
        low = np.zeros(n_rows + n_margins)
        high = np.concatenate([np.zeros(n_rows), np.full(n_margins, np.inf)])
        solution = solver(x0=task.start, p=task.design, lbx=lower, ubx=upper, lbg=low, ubg=high)
        return np.array(solution["x"]).ravel()

    def by_slsqp(task: PoseTask) -> Array:
        return _slsqp(bench, task)

    return [Contender("sqp", own), Contender("ipopt", by_ipopt), Contender("slsqp", by_slsqp)]


def _accepted_cost(bench: Workbench, task: PoseTask, y: Array) -> float:
    if not np.all(np.isfinite(y)):
        return np.nan
    kernels = bench.kernels[task.pose]
    bounds = pose_bounds(bench.spec, task.pose, kernels.layout)
    if not measure(kernels, task.design, 0.0, y, bounds).acceptable:
        return np.nan
    residuals = kernels.constraints(task.design, 0.0, y)[0]
    return float(residuals @ residuals)


def _compiled_ipopt(
    bench: Workbench, pose: str, cache: Path
) -> tuple[ca.Function, tuple[int, int]]:
    """IPOPT over compiled objective, constraints, gradient, Jacobian and Hessian."""
    model = PoseModel(bench.spec, pose)
    margins = ca.vertcat(model.opposition_margin(), model.skin_margin(), model.collision_margin())
    rows = model.rows()
    cost, constraints = ca.substitute(
        [ca.sumsqr(model.cost()), ca.vertcat(rows, margins)], [model.turn], [ca.SX(0)]
    )
    program = {"x": model.y, "p": model.d, "f": cost, "g": constraints}
    library = cache / f"nlp-{pose}-{cache_key(pose, 'nlp')}.so"
    if not library.exists():
        plain = ca.nlpsol("nlp", "ipopt", program, IPOPT_OPTIONS)
        source = cache / f"nlp_{pose}.c"
        plain.generate_dependencies(source.name)
        Path(source.name).replace(source)
        command = [str(compiler()), *COMPILER_FLAGS, str(source), "-lm", "-o", str(library)]
        subprocess.run(command, check=True)
    size = (rows.numel(), margins.numel())
    return ca.nlpsol("nlp", "ipopt", str(library), IPOPT_OPTIONS), size


def _slsqp(bench: Workbench, task: PoseTask) -> Array:
    """SciPy's SLSQP in the same scaled variables as the own solver."""
    kernels = bench.kernels[task.pose]
    program = build_pose_program(bench.spec, task.pose, kernels, task.design)
    scale = program.scale

    def cost(z: Array) -> tuple[float, Array]:
        at = program.evaluate(z * scale)
        return float(at.residuals @ at.residuals), 2 * at.residuals @ at.residuals_jacobian * scale

    constraints = [
        {
            "type": "eq",
            "fun": lambda z: program.evaluate(z * scale).rows.copy(),
            "jac": lambda z: program.evaluate(z * scale).rows_jacobian * scale,
        },
        {
            "type": "ineq",
            "fun": lambda z: program.evaluate(z * scale).margins.copy(),
            "jac": lambda z: program.evaluate(z * scale).margins_jacobian * scale,
        },
    ]
    bounds = list(zip(program.lower / scale, program.upper / scale, strict=True))
    start = np.clip(task.start, program.lower, program.upper) / scale
    options = {"maxiter": 200, "ftol": 1e-10}
    result = minimize(
        cost,
        start,
        jac=True,
        bounds=bounds,
        constraints=constraints,
        method="SLSQP",
        options=options,
    )
    return np.clip(result.x * scale, program.lower, program.upper)
