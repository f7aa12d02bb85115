"""The same pose programs by IPOPT with exact Hessians: the slow reference of the own solver."""

from __future__ import annotations

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from fpcad.model.pose import PoseModel
from fpcad.solve.program import Program, SolveResult
from fpcad.spec.schema import Spec

Array = NDArray[np.float64]

OPTIONS = {
    "print_time": False,
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "ipopt.tol": 1e-9,
    "ipopt.constr_viol_tol": 1e-10,
    "ipopt.bound_relax_factor": 0.0,
    "ipopt.mu_strategy": "adaptive",
    "ipopt.max_iter": 500,
}


def build_ipopt(spec: Spec, pose: str) -> ca.Function:
    """IPOPT solver of one pose's program, for any design and bounds."""
    model = PoseModel(spec, pose)
    margins = ca.vertcat(model.opposition_margin(), model.skin_margin(), model.collision_margin())
    constraints = ca.vertcat(model.rows(), margins)
    cost, constraints = ca.substitute(
        [ca.sumsqr(model.cost()), constraints], [model.turn], [ca.SX(0)]
    )
    program = {"x": model.y, "p": model.d, "f": cost, "g": constraints}
    return ca.nlpsol("ipopt", "ipopt", program, OPTIONS)


def solve_ipopt(solver: ca.Function, program: Program, design: Array, start: Array) -> SolveResult:
    """Minimize a pose program (built for `design`) from `start` (n,)."""
    at = program.evaluate(np.clip(start, program.lower, program.upper))
    n_rows, n_margins = len(at.rows), len(at.margins)
    solution = solver(
        x0=start,
        p=design,
        lbx=program.lower,
        ubx=program.upper,
        lbg=np.zeros(n_rows + n_margins),
        ubg=np.concatenate([np.zeros(n_rows), np.full(n_margins, np.inf)]),
    )
    statistics = solver.stats()
    values = np.array(solution["g"]).ravel()
    violation = max(np.abs(values[:n_rows]).max(), -values[n_rows:].min(initial=0.0))
    return SolveResult(
        y=np.array(solution["x"]).ravel(),
        cost=float(solution["f"]),
        violation=float(violation),
        iterations=int(statistics["iter_count"]),
        converged=bool(statistics["success"]),
    )
