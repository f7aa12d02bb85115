"""The solved poses of all candidates as arrays."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fpcad.look.run import Run
from fpcad.model.pose import StateLayout
from fpcad.model.state import state_columns
from fpcad.select.columns import numbers
from fpcad.spec.schema import Spec
from fpcad.spec.templates import TEMPLATES

Array = NDArray[np.float64]


def layout_of(spec: Spec, pose: str) -> StateLayout:
    """Where hand pose, joints and contacts lie in a pose's state."""
    names = TEMPLATES[spec.hand.template]
    return StateLayout(len(names.fingers), len(names.joints), len(spec.poses[pose].contacts))


def pose_states(run: Run, pose: str) -> Array:
    """(n, layout.size) states y [mm, rad] of one pose, in the order of the run's table."""
    names = TEMPLATES[run.spec.hand.template]
    columns = state_columns(pose, names, layout_of(run.spec, pose))
    table = run.candidates.sort_by("id")
    return np.column_stack([numbers(table, column) for column in columns])
