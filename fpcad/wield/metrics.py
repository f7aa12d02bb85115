"""How well a path wields the tool. docs/model.md, Metrics."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.units import DEG_PER_RAD
from fpcad.wield.path import WieldingPath
from fpcad.wield.trace import Trace

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PathMetrics:
    """Metrics of one path; the field names are the columns of the metrics table."""

    tmr_deg: float
    """Tool motion range, both directions added [deg]; 0 when neither makes one full step."""
    mss_mm_s: float
    """Sliding speed at a tool rate of 1 rad/s, mean over contacts and path [mm/s]; NaN without a path."""
    mft_nmm: float
    """Largest finger torque along the path [N mm]."""
    mft_p90_nmm: float
    """90th percentile of the finger torque over the tool angle [N mm]."""
    tip_force_n: float
    """Tip force that the motors hold everywhere along the path [N]."""
    end_plus: str
    end_minus: str


def path_metrics(path: WieldingPath, minus: Trace, plus: Trace, full_step: float) -> PathMetrics:
    """Metrics of a path and the two traces that it was joined from.

    Args:
        full_step: length of an integration step [rad].
    """
    angle = path.tool_angle_rad
    turn = float(angle[-1] - angle[0])
    moved = max(angle[-1], -angle[0]) >= full_step * (1 - 1e-9)
    slid = sum(state.sliding_mm for trace in (minus, plus) for state in trace.states)
    n_contacts = path.contacts.shape[1]
    return PathMetrics(
        tmr_deg=turn * DEG_PER_RAD if moved else 0.0,
        mss_mm_s=slid / (n_contacts * turn) if moved else np.nan,
        mft_nmm=float(path.torque_nmm.max()),
        mft_p90_nmm=percentile_over(angle, path.torque_nmm, 0.9),
        tip_force_n=float(path.tip_force_n.min()),
        end_plus=path.end_plus,
        end_minus=path.end_minus,
    )


def percentile_over(axis: Array, values: Array, fraction: float) -> float:
    """Value below which `values` (N,) stay on a fraction of an increasing `axis` (N,).

    Each sample stands for the part of the axis that is nearest to it.
    """
    if len(values) == 1:
        return float(values[0])
    edges = np.concatenate([axis[:1], (axis[1:] + axis[:-1]) / 2, axis[-1:]])
    order = np.argsort(values, kind="stable")
    covered = np.cumsum(np.diff(edges)[order]) / (axis[-1] - axis[0])
    return float(values[order][np.searchsorted(covered[:-1], fraction)])
