"""The tree of a real spec: it does not depend on how many processes grow it, nor on a pause."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from itertools import islice
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.distance import pdist

from fpcad.sample.rrt import ACCEPTED, Call, Proposal, grow
from fpcad.sample.space import DesignSpace
from fpcad.sample.tree import Candidate, Tree
from fpcad.solve.attempt import Attempt, Workbench, attempt, held, open_workbench
from fpcad.spec.process import Sampling
from fpcad.spec.schema import Spec
from fpcad.workers import InProcess, ProcessPool, Workers
from tests.model.plain_hand import Array

SETTINGS = Sampling(candidates=14, seed=2)

Grown = tuple[Tree, list[Call]]


def attempt_item(
    space: DesignSpace, bench: Workbench, item: tuple[Proposal, dict[str, Array]]
) -> Attempt:
    proposal, states = item
    return attempt(bench, space.internal(proposal.named), states)


def solve_batch(
    workers: Workers[Workbench],
    space: DesignSpace,
    items: Sequence[tuple[Proposal, dict[str, Array]]],
) -> list[Attempt]:
    return list(workers.map(partial(attempt_item, space), items))


def grown(
    workers: Workers[Workbench], space: DesignSpace, first_hand, batches: int = 1000
) -> Grown:
    tree, calls = Tree(space), []
    tree.add(Candidate(0, -1, first_hand.named, first_hand.attempt.poses))
    growing = grow(tree, SETTINGS, partial(solve_batch, workers, space), calls)
    for _ in islice(growing, batches):
        pass
    return tree, calls


@pytest.fixture(scope="module")
def alone(bench: Workbench, clay_space: DesignSpace, first_hand) -> Grown:
    """The tree grown by this process."""
    return grown(InProcess(lambda: bench), clay_space, first_hand)


def assert_same(one: Grown, two: Grown) -> None:
    """The same calls and candidates, to the last bit."""
    assert [(c.outcome, c.candidate) for c in one[1]] == [(c.outcome, c.candidate) for c in two[1]]
    for ours, theirs in zip(one[0].candidates, two[0].candidates, strict=True):
        assert ours.parent == theirs.parent and np.array_equal(ours.named, theirs.named)
        for pose, solved in ours.poses.items():
            assert np.array_equal(solved.y, theirs.poses[pose].y)


def test_two_processes_grow_the_same_tree(
    clay: Spec, kernel_cache: Path, clay_space: DesignSpace, first_hand, alone: Grown
):
    with ProcessPool(partial(open_workbench, clay, kernel_cache), 2) as workers:
        assert_same(grown(workers, clay_space, first_hand), alone)


def test_a_pause_changes_nothing(
    bench: Workbench, clay_space: DesignSpace, first_hand, alone: Grown
):
    workers = InProcess(lambda: bench)
    tree, calls = grown(workers, clay_space, first_hand, batches=1)
    assert len(tree.candidates) < SETTINGS.candidates
    for _ in grow(tree, SETTINGS, partial(solve_batch, workers, clay_space), calls):
        pass
    assert_same((tree, calls), alone)


def test_candidates_keep_their_distance(clay_space: DesignSpace, alone: Grown):
    tree, _ = alone
    assert len(tree.candidates) == SETTINGS.candidates
    points = clay_space.standardize(np.array([c.named for c in tree.candidates]))
    assert pdist(points).min() >= SETTINGS.min_distance


def test_every_candidate_reaches_and_holds_all_poses(
    bench: Workbench, clay_space: DesignSpace, alone: Grown
):
    for candidate in alone[0].candidates:
        assert set(candidate.poses) == {"carve", "poke", "press"}
        for pose, solved in candidate.poses.items():
            assert solved.residual.acceptable
            assert held(bench, pose, clay_space.internal(candidate.named), solved.y)


def test_most_calls_next_to_the_middle_of_the_box_succeed(alone: Grown):
    outcomes = [call.outcome for call in alone[1]]
    assert outcomes.count(ACCEPTED) > len(outcomes) / 2
