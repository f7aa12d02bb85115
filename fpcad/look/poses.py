"""The solved poses of all candidates as arrays."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fpcad.look.layout import columns_of
from fpcad.look.run import Run
from fpcad.select.columns import numbers

Array = NDArray[np.float64]


def pose_states(run: Run, pose: str) -> Array:
    """(n, layout.size) states y [mm, rad] of one pose, in the order of the run's table."""
    table = run.candidates.sort_by("id")
    return np.column_stack([numbers(table, column) for column in columns_of(run.spec, pose)])
