"""How the tree grows, shown on a made-up world in which designs are feasible by a rule."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import islice, pairwise

import numpy as np
import pytest
from scipy.spatial.distance import pdist

from fpcad.sample.rrt import (
    ACCEPTED,
    TOO_CLOSE,
    Call,
    Proposal,
    efficiency,
    grow,
    propose,
    stop_reason,
)
from fpcad.sample.space import DesignSpace
from fpcad.sample.tree import Candidate, Tree
from fpcad.solve.attempt import Attempt, SolvedPose
from fpcad.solve.measure import Residual
from fpcad.spec.process import Sampling
from tests.model.plain_hand import Array

SPACE = DesignSpace(("a_mm", "b_mm"), np.array([0.0, 100.0]), np.array([10.0, 120.0]))
SETTINGS = Sampling(candidates=60, seed=3, batch=8, max_calls=5000)
Rule = Callable[[Array], bool]
Items = Sequence[tuple[Proposal, dict[str, Array]]]


def everywhere(_: Array) -> bool:
    return True


def in_disc(named: Array) -> bool:
    """Half of the box's width across."""
    return bool(np.linalg.norm(SPACE.standardize(named)) < 0.25)


def solved(named: Array) -> SolvedPose:
    """A pose whose state is its design."""
    return SolvedPose(named, 0.0, Residual(0.0, 0.0, 1.0, 1.0), 1)


def attempts(rule: Rule, seen: list[Items] | None = None):
    """A solver of batches that follows a rule."""

    def solve(items: Items) -> list[Attempt]:
        if seen is not None:
            seen.append(items)
        return [
            Attempt(
                p.named,
                {"grip": solved(p.named)} if rule(p.named) else {},
                "" if rule(p.named) else "grip: solve",
            )
            for p, _ in items
        ]

    return solve


def seedling(point: tuple[float, float] = (0.0, 0.0)) -> Tree:
    tree = Tree(SPACE)
    named = SPACE.named(np.array(point))
    tree.add(Candidate(0, -1, named, {"grip": solved(named)}))
    return tree


def grown(settings: Sampling, rule: Rule = everywhere) -> tuple[Tree, list[Call]]:
    tree, calls = seedling(), []
    for _ in grow(tree, settings, attempts(rule), calls):
        pass
    return tree, calls


def changed(**values: object) -> Sampling:
    return SETTINGS.model_copy(update=values)


def designs(tree: Tree) -> Array:
    return np.array([candidate.named for candidate in tree.candidates])


def test_candidates_keep_their_distance():
    tree, _ = grown(SETTINGS)
    assert len(tree.candidates) == 60
    assert pdist(SPACE.standardize(designs(tree))).min() >= 1 / 30


def test_every_candidate_is_one_step_from_its_parent():
    tree, _ = grown(SETTINGS)
    points = SPACE.standardize(designs(tree))
    for candidate in tree.candidates[1:]:
        assert 0 <= candidate.parent < candidate.id
        length = np.linalg.norm(points[candidate.id] - points[candidate.parent])
        assert length <= SETTINGS.step * (1 + 1e-12)


def test_candidates_obey_the_rule_and_the_box():
    tree, calls = grown(SETTINGS, in_disc)
    assert all(in_disc(named) for named in designs(tree))
    assert {call.outcome for call in calls} == {ACCEPTED, TOO_CLOSE, "grip: solve"}
    for call in calls:
        if call.outcome == "grip: solve":
            assert not in_disc(call.proposal.named)


@pytest.mark.parametrize("seed", range(20))
def test_a_proposal_steps_from_the_nearest_candidate_towards_the_sample(seed: int):
    tree, _ = grown(SETTINGS)
    settings = changed(seed=seed)
    proposal = propose(tree, settings, 7)
    sample = np.random.default_rng([seed, 7]).uniform(-0.5, 0.5, 2)
    distances = np.linalg.norm(SPACE.standardize(designs(tree)) - sample, axis=1)
    assert proposal.parent == np.argmin(distances)
    start = SPACE.standardize(tree.candidates[proposal.parent].named)
    way = SPACE.standardize(proposal.named) - start
    assert np.linalg.norm(way) == pytest.approx(min(settings.step, distances.min()))
    towards = (sample - start) / np.linalg.norm(sample - start)
    assert np.allclose(way, (way @ towards) * towards) and way @ towards > 0


def test_poses_are_attempted_from_the_parents_states():
    seen: list[Items] = []
    tree = seedling()
    for _ in grow(tree, SETTINGS, attempts(everywhere, seen), []):
        pass
    for proposal, states in (item for batch in seen for item in batch):
        assert np.array_equal(states["grip"], tree.candidates[proposal.parent].named)


def test_too_close_proposals_are_never_attempted():
    seen: list[Items] = []
    tree, calls = seedling(), []
    for _ in grow(tree, SETTINGS, attempts(everywhere, seen), calls):
        pass
    attempted = {proposal.call for batch in seen for proposal, _ in batch}
    for call in calls:
        if call.proposal.call not in attempted:
            assert call.outcome == TOO_CLOSE


def test_a_batch_is_proposed_from_one_tree_and_accepted_in_order():
    """Of two proposals of a batch that lie too close, the first one stays."""
    tree, calls = seedling(), []
    for batch in grow(tree, changed(batch=32), attempts(everywhere), calls):
        before = len(tree.candidates) - sum(call.outcome == ACCEPTED for call in batch)
        assert all(call.proposal.parent < before for call in batch)
        accepted = [call.candidate for call in batch if call.outcome == ACCEPTED]
        assert accepted == list(range(before, before + len(accepted)))
    assert [call.proposal.call for call in calls] == list(range(len(calls)))


def test_the_last_batch_stops_at_the_number_of_candidates():
    tree, calls = grown(changed(candidates=13, batch=16))
    assert len(tree.candidates) == 13
    assert calls[-1].outcome == ACCEPTED  # later proposals of the batch are no calls


@pytest.mark.parametrize("seed", [0, 1])
def test_the_same_seed_grows_the_same_tree(seed: int):
    one, two = (grown(changed(seed=seed), in_disc) for _ in range(2))
    assert np.array_equal(designs(one[0]), designs(two[0]))
    assert [call.outcome for call in one[1]] == [call.outcome for call in two[1]]


def test_another_seed_grows_another_tree():
    one, two = (designs(grown(changed(seed=seed))[0]) for seed in (0, 1))
    assert not np.allclose(one[1:], two[1:])


@pytest.mark.parametrize("batches", [1, 3, 7])
def test_an_interrupted_tree_continues_as_if_it_had_not_been(batches: int):
    whole, whole_calls = grown(SETTINGS, in_disc)
    tree, calls = seedling(), []
    for _ in islice(grow(tree, SETTINGS, attempts(in_disc), calls), batches):
        pass
    read_back = Tree(SPACE)
    for candidate in tree.candidates:
        read_back.add(candidate)
    calls = list(calls)
    for _ in grow(read_back, SETTINGS, attempts(in_disc), calls):
        pass
    assert np.array_equal(designs(read_back), designs(whole))
    assert [call.outcome for call in calls] == [call.outcome for call in whole_calls]


class TestStops:
    def test_at_the_number_of_candidates(self):
        tree, calls = grown(SETTINGS)
        assert stop_reason(tree, SETTINGS, calls) == "60 candidates reached"

    def test_at_the_number_of_calls(self):
        settings = changed(candidates=10_000, max_calls=80)
        tree, calls = grown(settings)
        assert len(calls) == 80
        assert stop_reason(tree, settings, calls) == "80 calls made"

    def test_when_hardly_anything_is_accepted(self):
        settings = changed(candidates=10_000, efficiency_window=200, min_efficiency=0.05)
        tree, calls = grown(settings, in_disc)
        assert stop_reason(tree, settings, calls) == "efficiency below 5.00% over 200 calls"
        assert efficiency(calls[-200:]) < 0.05
        batch = settings.batch
        assert efficiency(calls[-200 - batch : -batch]) >= 0.05  # no sooner

    def test_not_before_a_window_is_full(self):
        settings = changed(efficiency_window=200, min_efficiency=0.5)
        tree, rejected = seedling(), Call(Proposal(0, 0, np.zeros(2)), TOO_CLOSE, -1)
        assert stop_reason(tree, settings, [rejected] * 199) is None
        assert stop_reason(tree, settings, [rejected] * 200) is not None


def test_efficiency_is_the_share_of_accepted_calls():
    tree, calls = grown(SETTINGS, in_disc)
    assert efficiency(calls) == pytest.approx((len(tree.candidates) - 1) / len(calls))
    assert efficiency([]) == 0


def test_a_full_box_is_packed_to_the_minimum_distance():
    """With the efficiency rule alone the tree fills the box: no room is left for many more."""
    settings = changed(candidates=100_000, max_calls=100_000, min_distance=0.1, step=0.15)
    tree, _ = grown(settings)
    points = SPACE.standardize(designs(tree))
    probes = np.random.default_rng(0).uniform(-0.5, 0.5, (2000, 2))
    nearest = np.min(np.linalg.norm(points[None] - probes[:, None], axis=2), axis=1)
    assert (nearest >= 0.1).mean() < 0.05
    assert pdist(points).min() >= 0.1


def test_ids_follow_each_other():
    tree = seedling()
    with pytest.raises(ValueError, match="candidate 5 does not follow 0"):
        tree.add(Candidate(5, 0, SPACE.named(np.zeros(2)), {}))


def test_a_tree_has_room_for_any_number():
    tree, random = seedling(), np.random.default_rng(0)
    for i, point in enumerate(random.uniform(-0.5, 0.5, (300, 2)), start=1):
        tree.add(Candidate(i, i - 1, SPACE.named(point), {}))
    for a, b in pairwise(range(0, 301, 50)):
        for place in (a, b):
            assert tree.nearest(tree.point(place)) == (place, 0.0)
