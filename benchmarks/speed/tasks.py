"""The tasks that all contenders get: real candidates of a design and their neighbours."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fpcad.model.state import pose_state
from fpcad.sample.rrt import Call, Proposal, grow, propose
from fpcad.sample.space import design_space
from fpcad.sample.tree import Candidate, Tree
from fpcad.solve.attempt import Attempt, Workbench, attempt, open_workbench
from fpcad.spec import Spec, load_spec

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PoseTask:
    """One pose of a new hand, from its parent's state."""

    pose: str
    design: Array  # (n_d,) [mm, rad]
    start: Array  # state of the parent


def workbench(design: str, build: Path) -> Workbench:
    """The formulas of a design, compiled into the build folder's cache."""
    return open_workbench(load_spec(Path("designs") / f"{design}.yaml"), build / ".kernels")


def grown_tree(bench: Workbench, candidates: int) -> Tree:
    """A tree as the design's own sampling grows it, in this process."""
    space, initial = design_space(bench.spec.hand), bench.spec.initial
    if initial is None:
        raise ValueError("the benchmarks need a design with an initial hand")
    named = np.array([initial.design[name] for name in space.names])
    states = {p: pose_state(given, bench.template.names) for p, given in initial.poses.items()}
    tree = Tree(space)
    first = attempt(bench, space.internal(named), states)
    tree.add(Candidate(0, -1, named, first.poses))
    settings = bench.spec.sampling.model_copy(update={"candidates": candidates})
    calls: list[Call] = []

    def solve(batch: Sequence[tuple[Proposal, dict[str, Array]]]) -> list[Attempt]:
        return [attempt(bench, space.internal(p.named), parent) for p, parent in batch]

    for _ in grow(tree, settings, solve, calls):
        pass
    return tree


def neighbours(bench: Workbench, tree: Tree, count: int, seed: int) -> Iterator[list[PoseTask]]:
    """Tasks of `count` RRT calls that the tree would make next, all poses of each."""
    sampling = bench.spec.sampling.model_copy(update={"seed": seed})
    for call in range(count):
        proposal = propose(tree, sampling, call)
        design = tree.space.internal(proposal.named)
        if bench.template.feasible(design):
            poses = tree.candidates[proposal.parent].poses
            yield [PoseTask(pose, design, solved.y) for pose, solved in poses.items()]


def with_solver(spec: Spec, method: str) -> Spec:
    """The same spec with another pose solver."""
    return spec.model_copy(update={"solver": spec.solver.model_copy(update={"method": method})})
