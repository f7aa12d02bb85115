"""Where things lie in the states of a spec's poses."""

from __future__ import annotations

from fpcad.model.pose import StateLayout
from fpcad.model.state import state_columns
from fpcad.spec.schema import Spec
from fpcad.spec.templates import TEMPLATES


def layout_of(spec: Spec, pose: str) -> StateLayout:
    """Where hand pose, joints and contacts lie in a pose's state."""
    names = TEMPLATES[spec.hand.template]
    return StateLayout(len(names.fingers), len(names.joints), len(spec.poses[pose].contacts))


def columns_of(spec: Spec, pose: str) -> list[str]:
    """Names of a pose's state in candidates.parquet."""
    return state_columns(pose, TEMPLATES[spec.hand.template], layout_of(spec, pose))
