from pathlib import Path

import numpy as np
import pytest

from fpcad.solve.qp import BACKENDS, QuadraticProgram

FILE = Path(__file__).parent / "data" / "nearly_singular_qp.npz"
"""A rate program met on a path, whose Hessian's eigenvalues span ten decades."""


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_feasible_program_is_solved_though_its_hessian_is_nearly_singular(backend):
    with np.load(FILE) as arrays:
        program = QuadraticProgram(**arrays)
    solution = BACKENDS[backend](program)
    assert solution is not None
    rows = program.A @ solution.x
    assert np.all(rows >= program.row_lower - 1e-6)
    assert np.all(rows <= program.row_upper + 1e-6)
    assert np.all(solution.x >= program.lower - 1e-6)
    assert np.all(solution.x <= program.upper + 1e-6)
