"""Scores: every metric of every pose on one scale, 0 for the run's worst hand to 100 for its best."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from fpcad.select.columns import numbers, with_column
from fpcad.spec.process import Selection

Array = NDArray[np.float64]
Better = Literal["larger", "smaller"]

BEST = 100.0
MEAN_SCORE = "mean_score"


class Metric(NamedTuple):
    """A column of the metrics table that is scored, for each pose."""

    column: str  # `<pose>_<column>` in the table
    score: str  # `<pose>_<score>` is added
    better: Better
    resolution: float  # differences below it do not count, in the column's unit


def scored_metrics(selection: Selection) -> tuple[Metric, ...]:
    """The metrics that are scored for each pose: range, sliding and torque of its path."""
    resolution = selection.resolutions
    return (
        Metric("tmr_deg", "tmr_score", "larger", resolution.tmr_deg),
        Metric("mss_mm_s", "mss_score", "smaller", resolution.mss_mm_s),
        Metric(f"{selection.torque}_nmm", "torque_score", "smaller", resolution.mft_nmm),
    )


def score_columns(
    poses: Sequence[str], selection: Selection, more: Sequence[Metric] = ()
) -> list[str]:
    """Names of the score columns, without the mean, in the order of the table."""
    metrics = (*scored_metrics(selection), *more)
    return [f"{pose}_{metric.score}" for pose in poses for metric in metrics]


def score(values: Array, better: Better, resolution: float) -> Array:
    """Linear scores of the values of one metric over a run.

    Args:
        values: (n,) in any unit; NaN where a hand has no path to be judged.
        better: which values are good.
        resolution: values are rounded to its multiples first, so that solver noise never ranks.

    Returns:
        (n,) scores: 0 for the worst value, 100 for the best, 100 for all when they are equal.
        NaN scores 0 and has no part in what is worst and best.
    """
    steps = np.rint(np.asarray(values, dtype=np.float64) / resolution)
    if np.isinf(steps).any():
        raise ValueError("a metric must be finite, or NaN where there is no path")
    known = ~np.isnan(steps)
    scores = np.zeros(steps.shape)
    if not known.any():
        return scores
    worst, best = float(steps[known].min()), float(steps[known].max())
    if better == "smaller":
        worst, best = best, worst
    scores[known] = BEST if worst == best else BEST * abs(steps[known] - worst) / abs(best - worst)
    return scores


def score_table(
    metrics: pa.Table, poses: Sequence[str], selection: Selection, more: Sequence[Metric] = ()
) -> pa.Table:
    """The metrics table with a score for each pose and metric, and their mean.

    A pose without a path, whose range of motion is 0, scores 0 in all of its metrics.

    Args:
        metrics: n rows; `<pose>_tmr_deg` [deg], `<pose>_mss_mm_s` [mm/s], `<pose>_mft_nmm` and
            `<pose>_mft_p90_nmm` [N mm].
        poses: names of the poses.
        selection: torque metric and resolutions.
        more: metrics that are scored beside fpcad's own.

    Returns:
        The n rows with `<pose>_tmr_score`, `<pose>_mss_score`, `<pose>_torque_score`, those of
        `more` and `mean_score` added, each from 0 to 100.
    """
    for pose in poses:
        has_path = numbers(metrics, f"{pose}_tmr_deg") > 0  # False for NaN
        for metric in (*scored_metrics(selection), *more):
            values = np.where(has_path, numbers(metrics, f"{pose}_{metric.column}"), np.nan)
            scores = score(values, metric.better, metric.resolution)
            metrics = with_column(metrics, f"{pose}_{metric.score}", scores)
    means = score_matrix(metrics, poses, selection, more).mean(axis=1)
    return with_column(metrics, MEAN_SCORE, means)


def score_matrix(
    table: pa.Table, poses: Sequence[str], selection: Selection, more: Sequence[Metric] = ()
) -> Array:
    """Scores (n, k n_poses) of a scored table, in the order of :func:`score_columns`."""
    return np.column_stack([numbers(table, name) for name in score_columns(poses, selection, more)])
