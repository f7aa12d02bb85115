"""Dense quadratic programs, and the backends that solve them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import daqp
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

UNBOUNDED = 1e30
_OPTIMAL = (1, 2)
_EQUALITY, _SOFT = 5, 8
DAQP_SETTINGS = {"primal_tol": 1e-11, "sing_tol": 1e-15}
"""DAQP's own primal tolerance is 1e-6, which is what we accept in the end, and its own threshold of
singularity calls feasible programs infeasible where the Hessian's eigenvalues span ten decades."""


@dataclass(frozen=True)
class QuadraticProgram:
    """minimize x'Hx/2 + f'x  subject to  lower <= x <= upper,  row_lower <= A x <= row_upper."""

    H: Array  # (n, n), positive definite
    f: Array  # (n,)
    lower: Array  # (n,)
    upper: Array  # (n,)
    A: Array  # (m, n)
    row_lower: Array  # (m,)
    row_upper: Array  # (m,); equal to row_lower for an equation


@dataclass(frozen=True)
class QpSolution:
    """A minimizer with its multipliers."""

    x: Array  # (n,)
    row_multipliers: Array  # (m,)


Backend = Callable[[QuadraticProgram], QpSolution | None]


def solve_daqp(program: QuadraticProgram) -> QpSolution | None:
    """Dual active-set method; None when there is no feasible point."""
    n = len(program.f)
    low = np.concatenate([program.lower, program.row_lower])
    high = np.concatenate([program.upper, program.row_upper])
    sense = np.where(low == high, _EQUALITY, 0).astype(np.int32)
    x, _, flag, info = daqp.solve(
        program.H, program.f, program.A, high, low, sense, **DAQP_SETTINGS
    )
    return QpSolution(x, info["lam"][n:]) if flag in _OPTIMAL else None


def solve_daqp_softly(program: QuadraticProgram) -> QpSolution | None:
    """As :func:`solve_daqp`, but rows may be violated at a steep price; bounds may not."""
    n = len(program.f)
    low = np.concatenate([program.lower, program.row_lower])
    high = np.concatenate([program.upper, program.row_upper])
    sense = np.full(len(low), _SOFT, dtype=np.int32)
    sense[:n] = np.where(program.lower == program.upper, _EQUALITY, 0)
    x, _, flag, info = daqp.solve(
        program.H, program.f, program.A, high, low, sense, **DAQP_SETTINGS
    )
    return QpSolution(x, info["lam"][n:]) if flag in _OPTIMAL else None


def solve_osqp(program: QuadraticProgram) -> QpSolution | None:
    """Operator splitting at tight tolerances, the slow cross-check; None when not solved."""
    import osqp
    from scipy import sparse

    n = len(program.f)
    solver = osqp.OSQP()
    rows = sparse.vstack([sparse.eye(n), sparse.csc_matrix(program.A)], format="csc")
    solver.setup(
        sparse.csc_matrix(np.triu(program.H)),
        program.f,
        rows,
        np.concatenate([program.lower, program.row_lower]),
        np.concatenate([program.upper, program.row_upper]),
        verbose=False,
        eps_abs=1e-9,
        eps_rel=1e-9,
        max_iter=50_000,
        polishing=True,
    )
    result = solver.solve(raise_error=False)
    if result.info.status_val != osqp.SolverStatus.OSQP_SOLVED:  # pyright: ignore[reportAttributeAccessIssue]
        return None
    return QpSolution(result.x, result.y[n:])


BACKENDS: dict[str, Backend] = {"daqp": solve_daqp, "osqp": solve_osqp}
"""Solvers that a spec may name."""
