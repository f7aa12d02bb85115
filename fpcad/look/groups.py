"""Clusters of designs and a flat map of the design space."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from fpcad.look.run import Run

Array = NDArray[np.float64]
Labels = NDArray[np.int64]

MAP_SEED = 0
MAP_PERPLEXITY = 30.0
LEAST_CLUSTER = 5
CLUSTER_SHARE = 50
"""A cluster has at least one in so many of the hands."""
NO_CLUSTER = -1
MAP_ROUNDS = 500
"""Iterations of t-SNE; twice as many take 80 s for 10,000 hands and look the same."""


@dataclass(frozen=True)
class DesignMap:
    """Where each hand lies in a plane."""

    points: Array  # (n, 2)
    axes: tuple[str, str]
    told: str
    """How the map was made, in words."""


def flat_map(standardized: Array, free_names: tuple[str, ...], named: Array) -> DesignMap:
    """The plane to draw landscapes over: the parameters themselves, or t-SNE of more than two.

    Args:
        standardized: (n, n_free) free parameters in [-0.5, 0.5].
        free_names: their names.
        named: (n, n_free) the same in the units of their names.
    """
    n, free = standardized.shape
    if free == 0:
        return DesignMap(
            np.zeros((n, 2)), ("", ""), "All parameters are held: there is one design."
        )
    if free <= 2:
        second = named[:, 1] if free == 2 else np.zeros(n)
        axes = (free_names[0], free_names[1] if free == 2 else "")
        return DesignMap(np.column_stack([named[:, 0], second]), axes, "The free parameters.")
    perplexity = min(MAP_PERPLEXITY, (n - 1) / 3)
    if perplexity < 1:
        return DesignMap(
            standardized[:, :2], (free_names[0], free_names[1]), "Too few hands for t-SNE."
        )
    told = f"t-SNE of {free} standardized parameters, perplexity {perplexity:g}, seed {MAP_SEED}"
    return DesignMap(_t_sne(standardized, perplexity), ("t-SNE 1", "t-SNE 2"), told)


def design_map(run: Run) -> DesignMap:
    """The plane that landscapes are drawn over."""
    free = run.space.free
    names = tuple(
        f"{column.label} [{column.unit}]" if column.unit else column.label
        for column, is_free in zip(run.parameters, free, strict=True)
        if is_free
    )
    return flat_map(run.space.standardize(run.designs), names, run.designs[:, free])


def clusters(standardized: Array) -> Labels:
    """HDBSCAN's cluster (n,) of each design, counted from 0 by falling size; -1 for none."""
    from sklearn.cluster import HDBSCAN

    n, free = standardized.shape
    least = max(LEAST_CLUSTER, n // CLUSTER_SHARE)
    if n < 2 * least or free == 0:
        return np.full(n, NO_CLUSTER)
    hdbscan = HDBSCAN(min_cluster_size=least, copy=True)  # pyright: ignore[reportArgumentType]
    labels = hdbscan.fit_predict(standardized)
    sizes = np.bincount(labels[labels >= 0])
    rank = np.empty(len(sizes) + 1, dtype=np.int64)
    rank[np.argsort(-sizes, kind="stable")] = np.arange(len(sizes))
    rank[-1] = NO_CLUSTER
    return rank[labels]


def representatives(labels: Labels, merit: Array, front: NDArray[np.bool_]) -> Labels:
    """Row of the best hand by `merit` (n,) of each cluster; NaN loses to everything.

    Hands of the front (n,) come first: their paths are kept.
    """
    found, merit = [], np.nan_to_num(merit, nan=-np.inf)
    for label in range(labels.max(initial=NO_CLUSTER) + 1):
        rows = np.flatnonzero(labels == label)
        rows = rows[front[rows]] if front[rows].any() else rows
        found.append(rows[np.argmax(merit[rows])])
    return np.array(found, dtype=np.int64)


def _t_sne(points: Array, perplexity: float) -> Array:
    """Barnes-Hut t-SNE (n, 2) of points (n, m), computed once for the same points."""
    return np.frombuffer(_t_sne_bytes(points.tobytes(), points.shape[1], perplexity)).reshape(-1, 2)


@lru_cache(maxsize=2)
def _t_sne_bytes(points: bytes, width: int, perplexity: float) -> bytes:
    """One thread, for sums over several differ in their last bits."""
    from sklearn.manifold import TSNE

    with threadpool_limits(limits=1):
        embedding = TSNE(
            perplexity=perplexity,
            init="pca",
            random_state=MAP_SEED,
            max_iter=MAP_ROUNDS,
            n_jobs=1,
        )
        drawn = embedding.fit_transform(np.frombuffer(points).reshape(-1, width))
        return np.asarray(drawn, dtype=np.float64).tobytes()
