"""A rapidly exploring random tree over the designs that reach all poses.

Proposals come in batches: all of a batch are made from the tree as it stood before, solved in any
order and by any number of workers, and accepted in the order of their numbers. Each call has its
own random numbers, so the result depends on the seed and the batch size alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.sample.tree import Candidate, Tree
from fpcad.solve.attempt import Attempt
from fpcad.spec.process import Sampling

Array = NDArray[np.float64]

TOO_CLOSE = "too close"
ACCEPTED = "accepted"


@dataclass(frozen=True)
class Proposal:
    """A design to try, next to a candidate."""

    call: int
    parent: int
    named: Array  # (n_d,) [mm, deg]


@dataclass(frozen=True)
class Call:
    """What became of one RRT call."""

    proposal: Proposal
    outcome: str
    """`accepted`, or the reason of the rejection."""
    candidate: int
    """Id of the accepted candidate, else -1."""


SolveBatch = Callable[[Sequence[tuple[Proposal, dict[str, Array]]]], Sequence[Attempt]]
"""Attempts proposals from their parents' states; results in the order of the proposals."""


def grow(
    tree: Tree, settings: Sampling, solve: SolveBatch, calls: list[Call]
) -> Iterator[list[Call]]:
    """Grow a tree until a stop rule holds; yields the calls of each batch after they are added.

    Args:
        tree: starts with at least one candidate; grows in place.
        settings: seed, batch, step, distances and stop rules.
        solve: attempts a batch of proposals.
        calls: all calls so far, empty at first; grows in place. A tree and calls that were read
            back from a store continue exactly where they ended.
    """
    while stop_reason(tree, settings, calls) is None:
        first = len(calls)
        proposals = [propose(tree, settings, first + i) for i in range(settings.batch)]
        far = [p for p in proposals if not _too_close(tree, settings, p)]
        states = [(p, {n: s.y for n, s in tree.candidates[p.parent].poses.items()}) for p in far]
        attempts = {p.call: a for p, a in zip(far, solve(states), strict=True)}
        batch: list[Call] = []
        for proposal in proposals:
            if len(tree.candidates) < settings.candidates:
                batch.append(_judge(tree, settings, proposal, attempts.get(proposal.call)))
        calls.extend(batch)
        yield batch


def propose(tree: Tree, settings: Sampling, call: int) -> Proposal:
    """A uniform sample, approached from the nearest candidate by at most one step."""
    random = np.random.default_rng([settings.seed, call])
    sample = random.uniform(-0.5, 0.5, int(tree.space.free.sum()))
    parent, distance = tree.nearest(sample)
    start = tree.point(parent)
    reach = min(1.0, settings.step / distance) if distance > 0 else 0.0
    return Proposal(call, parent, tree.space.named(start + reach * (sample - start)))


def stop_reason(tree: Tree, settings: Sampling, calls: Sequence[Call]) -> str | None:
    """Why sampling is over, or None while it is not."""
    if len(tree.candidates) >= settings.candidates:
        return f"{settings.candidates} candidates reached"
    if len(calls) >= settings.max_calls:
        return f"{settings.max_calls} calls made"
    window = settings.efficiency_window
    if len(calls) >= window and efficiency(calls[-window:]) < settings.min_efficiency:
        return f"efficiency below {settings.min_efficiency:.2%} over {window} calls"
    return None


def efficiency(calls: Sequence[Call]) -> float:
    """Share of accepted calls [-]; 0 without calls."""
    return sum(call.outcome == ACCEPTED for call in calls) / max(len(calls), 1)


def _judge(tree: Tree, settings: Sampling, proposal: Proposal, attempt: Attempt | None) -> Call:
    """Accept an attempt into the tree, or tell why not."""
    if attempt is None or _too_close(tree, settings, proposal):
        return Call(proposal, TOO_CLOSE, -1)
    if not attempt.succeeded:
        return Call(proposal, attempt.reason, -1)
    candidate = Candidate(len(tree.candidates), proposal.parent, proposal.named, attempt.poses)
    tree.add(candidate)
    return Call(proposal, ACCEPTED, candidate.id)


def _too_close(tree: Tree, settings: Sampling, proposal: Proposal) -> bool:
    return tree.nearest(tree.space.standardize(proposal.named))[1] < settings.min_distance
