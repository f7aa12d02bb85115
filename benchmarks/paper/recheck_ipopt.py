"""Random candidates of a build solved again by IPOPT from their own states: is there anything better?"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from fpcad.pipeline.sample import read_candidates
from fpcad.pipeline.stage import Build
from fpcad.sample.space import DesignSpace, design_space
from fpcad.sample.tree import Candidate
from fpcad.solve.attempt import Workbench, open_workbench, solve_pose
from fpcad.solve.ipopt import OPTIONS
from fpcad.spec.schema import Spec
from fpcad.workers import ProcessPool

Array = NDArray[np.float64]

SEED = 12
RELATIVE, ABSOLUTE = 0.01, 1e-4
"""A cost counts as no worse within 1 % or 1e-4, whichever is larger."""
SETTINGS: tuple[dict[str, float | str], ...] = (
    {
        "ipopt.bound_push": 1e-9,
        "ipopt.bound_frac": 1e-9,
        "ipopt.slack_bound_push": 1e-9,
        "ipopt.slack_bound_frac": 1e-9,
        "ipopt.mu_init": 1e-7,
    },
    {"ipopt.mu_strategy": "adaptive"},
)
"""Begin right at the state, bounds and all; else choose the barrier by the progress. With IPOPT's defaults
every third pose of four contacts ran out of iterations, moved away from its bounds at the start."""


@dataclass(frozen=True)
class PoseComparison:
    """Our costs of one pose beside IPOPT's; n poses, those that IPOPT did not solve left out."""

    asked: int
    ours: Array  # (n,)
    ipopt: Array  # (n,)

    @property
    def no_worse(self) -> int:
        """Poses whose cost is no worse than IPOPT's."""
        return int((self.ours <= self.ipopt + self._slack).sum())

    @property
    def better(self) -> int:
        """Poses where IPOPT ended with a cost that is worse than ours."""
        return int((self.ipopt > self.ours + self._slack).sum())

    @property
    def excess(self) -> Array:
        """(n,) by how much our cost is above IPOPT's."""
        return self.ours - self.ipopt

    @property
    def _slack(self) -> Array:
        return np.maximum(RELATIVE * np.abs(self.ipopt), ABSOLUTE)


def compare_with_ipopt(build: Build, count: int) -> dict[str, PoseComparison]:
    """Solve all poses of `count` random candidates with IPOPT, each from the stored state."""
    candidates = list(read_candidates(build))
    places = np.random.default_rng(SEED).permutation(len(candidates))[:count]
    chosen = [candidates[place] for place in sorted(places)]
    solver = build.spec.solver.model_copy(update={"method": "ipopt"})
    spec = build.spec.model_copy(update={"solver": solver})
    opener = partial(open_references, spec, build.kernel_cache)
    task = partial(ipopt_costs, design_space(spec.hand))
    found = []
    with (
        ProcessPool(opener, build.workers) as workers,
        build.reporter.stage("solving again with IPOPT", len(chosen)) as bar,
    ):
        for costs in workers.map(task, chosen):
            found.append(costs)
            bar.advance()
    return {pose: _compared(pose, chosen, found) for pose in spec.poses}


def open_references(spec: Spec, cache: Path) -> list[Workbench]:
    """Workbenches with IPOPT, each with other settings."""
    bench = open_workbench(spec, cache)
    return [_with_options(bench, options) for options in SETTINGS]


def _with_options(bench: Workbench, options: dict[str, float | str]) -> Workbench:
    references = {
        pose: ca.nlpsol("ipopt", "ipopt", solver.oracle(), OPTIONS | options)
        for pose, solver in bench.references.items()
    }
    return replace(bench, references=references)


def ipopt_costs(
    space: DesignSpace, benches: list[Workbench], candidate: Candidate
) -> dict[str, float | None]:
    """Cost of each pose where IPOPT ends in an acceptable state, with the first settings that do."""
    design, costs = space.internal(candidate.named), {}
    for pose, ours in candidate.poses.items():
        tries = (solve_pose(bench, pose, design, ours.y) for bench in benches)
        solved = next((found for found in tries if found is not None), None)
        costs[pose] = None if solved is None else solved.cost
    return costs


def _compared(
    pose: str, candidates: list[Candidate], found: list[dict[str, float | None]]
) -> PoseComparison:
    pairs = [
        (candidate.poses[pose].cost, cost)
        for candidate, costs in zip(candidates, found, strict=True)
        if (cost := costs[pose]) is not None
    ]
    both = np.array(pairs).reshape(-1, 2)
    return PoseComparison(len(candidates), both[:, 0], both[:, 1])
