"""The tree of candidates: hands that reach all poses, each with its parent."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from fpcad.sample.space import DesignSpace
from fpcad.solve.attempt import SolvedPose

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Candidate:
    """A hand that reaches and holds all poses."""

    id: int
    parent: int
    """Candidate that its poses were solved from; -1 for the first."""
    named: Array  # (n_d,) design [mm, deg]
    poses: dict[str, SolvedPose]


REBUILD_AFTER = 256
"""Candidates beside the search tree up to which looking at each is as fast."""


@dataclass
class Tree:
    """Candidates in the order of their acceptance."""

    space: DesignSpace
    candidates: list[Candidate] = field(default_factory=list)
    _points: Array = field(init=False)
    _search: KDTree | None = field(init=False, default=None)

    def __post_init__(self) -> None:
        self._points = np.zeros((REBUILD_AFTER, int(self.space.free.sum())))

    def add(self, candidate: Candidate) -> None:
        """Append a candidate; its id must be its place."""
        size = len(self.candidates)
        if candidate.id != size:
            raise ValueError(f"candidate {candidate.id} does not follow {size - 1}")
        if size == len(self._points):
            self._points = np.concatenate([self._points, np.zeros_like(self._points)])
        self._points[size] = self.space.standardize(candidate.named)
        self.candidates.append(candidate)
        if size + 1 - self._indexed == REBUILD_AFTER:
            self._search = KDTree(self._points[: size + 1].copy())

    def nearest(self, point: Array) -> tuple[int, float]:
        """Place and distance of the candidate nearest to a standardized point (n_free,).

        A k-d tree finds it among all but the newest candidates, which are looked at one by one.
        """
        newest = self._points[self._indexed : len(self.candidates)] - point
        squared = np.einsum("ij,ij->i", newest, newest)
        place, distance = -1, np.inf
        if len(squared):
            place = int(np.argmin(squared))
            place, distance = place + self._indexed, float(np.sqrt(squared[place]))
        if self._search is not None:
            found, older = self._search.query(point)
            if found <= distance:
                return int(older), float(found)
        return place, distance

    def point(self, place: int) -> Array:
        """Standardized design (n_free,) of a candidate."""
        return self._points[place]

    @property
    def _indexed(self) -> int:
        return 0 if self._search is None else self._search.n
