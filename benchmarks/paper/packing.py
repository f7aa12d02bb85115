"""How full the design space is, and how full sampling could make it if no hand failed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from fpcad.sample.rrt import ACCEPTED, Proposal, grow
from fpcad.sample.space import DesignSpace
from fpcad.sample.tree import Candidate, Tree
from fpcad.solve.attempt import Attempt
from fpcad.spec.process import Sampling

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Filling:
    """Sampling of a box in which every hand reaches its poses."""

    step: float
    window_candidates: int
    """Candidates when the last calls fall below the least efficiency."""
    window_calls: int
    total_candidates: int
    """Candidates after all calls that were asked for."""


def ball_share(points: Array, diameter: float) -> float:
    """Share of the unit cube that balls of a diameter around n points (n, k) have together."""
    n, k = points.shape
    unit_ball = math.pi ** (k / 2) / math.gamma(k / 2 + 1)
    return n * unit_ball * (diameter / 2) ** k


def least_distance(points: Array) -> float:
    """Distance of the two nearest of n points (n, k)."""
    distances, _ = KDTree(points).query(points, k=2)
    return float(distances[:, 1].min())


def fill_box(settings: Sampling, calls: int, dimensions: int = 2) -> Filling:
    """Run the sampling rule itself for a number of calls where no attempt fails."""
    names = tuple(f"x{i}" for i in range(dimensions))
    space = DesignSpace(names, np.full(dimensions, -0.5), np.full(dimensions, 0.5))
    tree, done = Tree(space), []
    tree.add(Candidate(0, -1, np.zeros(dimensions), {}))
    endless = settings.model_copy(update={"min_efficiency": 0.0, "max_calls": calls})

    def succeed(items: list[tuple[Proposal, dict]]) -> list[Attempt]:
        return [Attempt(proposal.named, {}, "") for proposal, _ in items]

    for _ in grow(tree, endless, succeed, done):  # pyright: ignore[reportArgumentType]
        pass
    accepted = accepted_outcomes([call.outcome for call in done])
    stop = window_stop(accepted, settings)
    return Filling(settings.step, 1 + int(accepted[:stop].sum()), stop, len(tree.candidates))


def accepted_outcomes(outcomes: Sequence[str]) -> NDArray[np.bool_]:
    """(n,) which calls gave a candidate."""
    return np.array([outcome == ACCEPTED for outcome in outcomes], dtype=bool)


def window_stop(accepted: NDArray[np.bool_], settings: Sampling) -> int:
    """Calls after which the mean over the window is below the least efficiency; all if never."""
    window = settings.efficiency_window
    total = np.concatenate([[0], np.cumsum(accepted)])
    means = (total[window:] - total[:-window]) / window
    below = np.flatnonzero(means < settings.min_efficiency)
    return int(below[0]) + window if len(below) else len(accepted)
