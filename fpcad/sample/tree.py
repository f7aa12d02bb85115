"""The tree of candidates: hands that reach all poses, each with its parent."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

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


@dataclass
class Tree:
    """Candidates in the order of their acceptance."""

    space: DesignSpace
    candidates: list[Candidate] = field(default_factory=list)
    _points: Array = field(init=False)

    def __post_init__(self) -> None:
        self._points = np.zeros((64, int(self.space.free.sum())))

    def add(self, candidate: Candidate) -> None:
        """Append a candidate; its id must be its place."""
        if candidate.id != len(self.candidates):
            raise ValueError(f"candidate {candidate.id} does not follow {len(self.candidates) - 1}")
        if candidate.id == len(self._points):
            self._points = np.concatenate([self._points, np.zeros_like(self._points)])
        self._points[candidate.id] = self.space.standardize(candidate.named)
        self.candidates.append(candidate)

    def nearest(self, point: Array) -> tuple[int, float]:
        """Place and distance of the candidate nearest to a standardized point (n_free,)."""
        offsets = self._points[: len(self.candidates)] - point
        squared = np.einsum("ij,ij->i", offsets, offsets)
        place = int(np.argmin(squared))
        return place, float(np.sqrt(squared[place]))

    def point(self, place: int) -> Array:
        """Standardized design (n_free,) of a candidate."""
        return self._points[place]
