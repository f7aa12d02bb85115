"""Ranking: the metrics table with scores, their mean and the Pareto front."""

from __future__ import annotations

from collections.abc import Sequence

import pyarrow as pa

from fpcad.select.columns import flags, with_column
from fpcad.select.front import pareto_front
from fpcad.select.scores import Metric, score_matrix, score_table
from fpcad.spec.process import Selection

PARETO = "pareto"


def rank_table(
    metrics: pa.Table, poses: Sequence[str], selection: Selection, more: Sequence[Metric] = ()
) -> pa.Table:
    """Add everything that a choice is made from.

    Scores run from the worst to the best of all n hands; only makeable ones are on the front.

    Args:
        metrics: n rows with `id`, `makeable`, `reason` and the metrics of each pose; see
            :func:`fpcad.select.scores.score_table`.
        poses: names of the poses.
        selection: torque metric and resolutions.
        more: metrics that are scored beside fpcad's own.

    Returns:
        The n rows in the same order, with the score columns, `mean_score` and `pareto` added.
    """
    table = score_table(metrics, poses, selection, more)
    front = pareto_front(score_matrix(table, poses, selection, more), flags(table, "makeable"))
    return with_column(table, PARETO, front)
