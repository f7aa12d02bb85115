"""What a run teaches: size of its front, and how each metric hangs on each parameter."""

from __future__ import annotations

from typing import NamedTuple

import moocore
import numpy as np
import pyarrow as pa
from numpy.typing import NDArray
from scipy.stats import spearmanr

from fpcad.look.groups import clusters
from fpcad.look.run import Run

Array = NDArray[np.float64]

BEST_SCORE = 100.0
EXACT_OBJECTIVES = 4
EXACT_POINTS = 60
"""Above both of these an exact hypervolume takes minutes to years."""
LEAST_HANDS = 20
"""With fewer measured hands importance would be that of noise."""
TREES, REPEATS, SEED = 100, 5, 0
HELD_BACK = 0.25
"""Share of the hands that the importances are measured on, not learnt from."""


class Hypervolume(NamedTuple):
    """Share of the box of scores that a front dominates."""

    value: float  # from 0 to 1
    exact: bool


def front_hypervolume(run: Run) -> Hypervolume:
    """Hypervolume of the run's front over all of its scores, against a hand with none."""
    scores = run.matrix([column.name for column in run.score_columns])[run.front]
    return hypervolume(scores / BEST_SCORE)


def hypervolume(points: Array) -> Hypervolume:
    """Part of the unit box that points (n, m) in [0, 1] dominate, large values being good.

    Over four objectives and 60 points it is approximated, deterministically, to about 1 %.
    """
    distinct = np.unique(points, axis=0)
    n, objectives = distinct.shape
    if n == 0 or objectives == 0:
        return Hypervolume(0.0, True)
    origin = np.zeros(objectives)
    if objectives <= EXACT_OBJECTIVES or n <= EXACT_POINTS:
        return Hypervolume(float(moocore.hypervolume(distinct, ref=origin, maximise=True)), True)
    return Hypervolume(float(moocore.hv_approx(distinct, ref=origin, maximise=True)), False)


def cluster_table(run: Run) -> pa.Table:
    """`id` and `cluster` of every candidate, counted from 0 by falling size; -1 for none."""
    labels = clusters(run.space.standardize(run.designs))
    return pa.table({"id": run.ids, "cluster": labels})


def sensitivity(run: Run, importances: bool = True) -> pa.Table:
    """How each metric hangs on each free parameter, over the measured hands.

    Args:
        run: the run.
        importances: whether to learn forests, which takes a second a metric with 10,000 hands.

    Returns:
        One row for each metric and parameter: `rank_correlation` (Spearman, -1 to 1),
        `importance` (how much of R^2 a random forest loses when the parameter is shuffled),
        `r_squared` of the forest on hands that it did not learn from, and `hands`, their number.
        NaN where there are too few hands, where a metric is the same for all, or unasked for.
    """
    free = run.space.free
    designs = run.designs[:, free]
    names = [name for name, is_free in zip(run.space.names, free, strict=True) if is_free]
    rows = []
    for column in run.metric_columns:
        values = run.matrix([column.name])[:, 0]
        known = np.isfinite(values)
        importance, fit = np.full(len(names), np.nan), float("nan")
        if importances:
            importance, fit = permutation_importance(designs[known], values[known])
        for k, name in enumerate(names):
            row = {"metric": column.name, "parameter": name, "hands": int(known.sum())}
            row["rank_correlation"] = rank_correlation(designs[known, k], values[known])
            rows.append({**row, "importance": importance[k], "r_squared": fit})
    return pa.Table.from_pylist(rows, SENSITIVITY)


SENSITIVITY = pa.schema(
    [
        ("metric", pa.string()),
        ("parameter", pa.string()),
        ("hands", pa.int64()),
        ("rank_correlation", pa.float64()),
        ("importance", pa.float64()),
        ("r_squared", pa.float64()),
    ]
)


def rank_correlation(x: Array, y: Array) -> float:
    """Spearman's correlation of x (n,) and y (n,); NaN where one of them does not vary."""
    if len(x) < 3 or np.ptp(x) == 0 or np.ptp(y) == 0:
        return float("nan")
    return float(np.asarray(spearmanr(x, y))[0])


def permutation_importance(x: Array, y: Array) -> tuple[Array, float]:
    """Importance (k,) of each column of x (n, k) for y (n,), and R^2 on hands held back.

    The same data give the same figures. NaN for fewer than 20 hands or a y that does not vary.
    """
    n, width = x.shape
    if n < LEAST_HANDS or width == 0 or np.ptp(y) == 0:
        return np.full(width, np.nan), float("nan")
    from sklearn import inspection
    from sklearn.ensemble import RandomForestRegressor
    from sklearn.model_selection import train_test_split

    x_known, x_new, y_known, y_new = train_test_split(x, y, test_size=HELD_BACK, random_state=SEED)
    forest = RandomForestRegressor(TREES, min_samples_leaf=2, random_state=SEED)
    forest.fit(x_known, y_known)
    told = inspection.permutation_importance(
        forest, x_new, y_new, n_repeats=REPEATS, random_state=SEED
    )
    return np.asarray(told["importances_mean"]), float(forest.score(x_new, y_new))
