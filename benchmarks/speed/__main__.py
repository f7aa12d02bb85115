"""`make bench`: attempts, paths, linear programs and the tree, each beside its baselines."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.speed.attempts import Contender, contenders
from benchmarks.speed.report import Figure, figure, print_figures, write_figures
from benchmarks.speed.tasks import grown_tree, neighbours, workbench
from benchmarks.speed.wielding import (
    Traced,
    along_edges,
    highs_greatest_load,
    highs_least_torque,
    own_trace,
    plain_trace,
)
from fpcad.model.equilibrium import greatest_load, least_torque
from fpcad.model.pose import HAND_SIZE
from fpcad.model.statics import cone_facets
from fpcad.sample.rrt import Call, Proposal, grow
from fpcad.sample.space import design_space
from fpcad.sample.tree import Candidate, Tree
from fpcad.solve.attempt import Attempt, Workbench
from fpcad.wield.evaluate import build_load, evaluate

BLOCK = 60
"""States that one solver gets in a row, so that each runs with its own code in the caches."""


def attempts(bench: Workbench, tree: Tree, calls: int, cache: Path) -> Iterator[Figure]:
    """Time of a call and quality of its poses, alternating over the same tasks."""
    solvers = contenders(bench, cache)
    for call in neighbours(bench, tree, calls, seed=7):
        for solver in solvers:
            solver.run(bench, call)
    own, *others = solvers
    ours = float(np.median(own.seconds)) * 1e3
    for other in others:
        theirs = float(np.median(other.seconds)) * 1e3
        yield figure(
            f"attempt of all poses, against {other.name}", ours, theirs, "ms", _quality(own, other)
        )
    poses = len(bench.spec.poses)
    yield figure("attempt, a pose, against 1 ms", ours / poses, 1.0, "ms")


def _quality(own: Contender, other: Contender) -> str:
    told = [f"accepted {own.success():.1%} against {other.success():.1%}"]
    for pose, costs in own.costs.items():
        pair = np.array([costs, other.costs[pose]])
        both = pair[:, np.all(np.isfinite(pair), axis=0)]
        if both.size:
            ours, theirs = np.median(both, axis=1)
            told.append(f"{pose} median cost {ours:.6f} against {theirs:.6f}")
    return "; ".join(told)


def paths(bench: Workbench, candidates: list[Candidate]) -> Iterator[Figure]:
    """Time of a candidate's paths, alternating; ranges and torques compared state by state."""
    own: list[float] = []
    plain: list[float] = []
    ranges, torques = [0.0], [0.0]
    for candidate in candidates:
        sums = np.zeros(2)
        for pose in bench.spec.poses:
            mine, other = np.zeros(2)
            for direction in (-1.0, 1.0):
                a = own_trace(bench, candidate, pose, direction)
                b = plain_trace(bench, candidate, pose, direction)
                sums += a.seconds, b.seconds
                mine, other = mine + a.range_deg, other + b.range_deg
                torques.append(_torque_deviation(a, b))
            ranges.append(abs(mine - other) / max(mine, other))
        own.append(sums[0])
        plain.append(sums[1])
    note = (
        f"motion ranges differ by {np.median(ranges):.2%} (median), {max(ranges):.2%} (most); "
        f"torques at common states by {np.median(torques):.2g} (median), {max(torques):.2g} (most)"
    )
    medians = float(np.median(own)) * 1e3, float(np.median(plain)) * 1e3
    yield figure("paths of a candidate, against OSQP + linprog", *medians, "ms", note)


def _torque_deviation(a: Traced, b: Traced) -> float:
    common = min(len(a.turns), len(b.turns))
    same = np.isclose(a.turns[:common], b.turns[:common], atol=1e-12)
    x, y = np.array(a.torques[:common])[same], np.array(b.torques[:common])[same]
    return float(np.max(np.abs(x - y) / y, initial=0.0))


def programs(bench: Workbench, candidates: list[Candidate]) -> Iterator[Figure]:
    """Both linear programs on the same states of real paths, a block of states at a time."""
    states = [pair for candidate in candidates for pair in _states(bench, candidate)]

    facets = cone_facets(bench.spec.statics)

    def own_least(W: Any, T: Any, load: Any, cap: float) -> float | None:
        held = least_torque(W, T, load, cap, facets)
        return None if held is None else held.largest_torque_nmm

    def own_greatest(W: Any, M: Any, load: Any, limit: Any) -> float:
        return greatest_load(W, M, load, limit, facets)

    contests = {
        "least torque": ([least for least, _ in states], own_least, highs_least_torque),
        "greatest tip force": ([most for _, most in states], own_greatest, highs_greatest_load),
    }
    for name, (arguments, ours, theirs) in contests.items():
        along = [(along_edges(W), along_edges(T), *rest) for W, T, *rest in arguments]
        seconds, worst = np.zeros(2), 0.0
        for start in range(0, len(arguments), BLOCK):
            mine, own_seconds = _timed(ours, arguments[start : start + BLOCK])
            others, other_seconds = _timed(theirs, along[start : start + BLOCK])
            seconds += own_seconds, other_seconds
            for a, b in zip(mine, others, strict=True):
                if a is None or b is None:
                    raise ValueError(f"{name}: {a} against {b}")
                worst = max(worst, abs(a - b) / max(abs(b), 1e-9))
        note = f"{len(arguments)} states, largest relative difference {worst:.2g}"
        own, other = seconds / len(arguments) * 1e6
        yield figure(f"{name}, against SciPy HiGHS", own, other, "us", note)


def _timed(solve: Callable[..., Any], states: list[tuple]) -> tuple[list[Any], float]:
    started = time.perf_counter()
    results = [solve(*arguments) for arguments in states]
    return results, time.perf_counter() - started


def _states(bench: Workbench, candidate: Candidate) -> Iterator[tuple[tuple, tuple]]:
    """Arguments of both programs at every third state of a candidate's paths."""
    states = {pose: solved.y for pose, solved in candidate.poses.items()}
    design = design_space(bench.spec.hand).internal(candidate.named)
    for pose, path in evaluate(bench, design, states).paths.items():
        load, hand = build_load(bench.spec, pose), states[pose][:HAND_SIZE]
        for i in range(1, len(path.tool_angle_rad) - 1, 3):
            x = np.concatenate([path.joints_rad[i].ravel(), path.contacts[i].ravel()])
            angle = float(path.tool_angle_rad[i])
            W, T, tip = (v.copy() for v in bench.kernels[pose].statics(design, hand, angle, x))
            pull, motors = (tip if angle >= 0 else -tip), load.motor_per_joint_torque @ T
            yield (
                (W, T, load.tip_force_n * pull, load.max_joint_torque_nmm),
                (W, motors, pull, load.motor_torque_nmm),
            )


def tree_cost(bench: Workbench, first: Candidate) -> Iterator[Figure]:
    """Cost of an RRT call outside the attempt, at 10,000 candidates beside that at 1,000."""
    settings = bench.spec.sampling.model_copy(update={"candidates": 10_500})
    tree, calls = Tree(design_space(bench.spec.hand)), list[Call]()
    tree.add(Candidate(0, -1, first.named, first.poses))
    marks: list[tuple[int, int, float]] = []

    def accept_all(batch: Sequence[tuple[Proposal, object]]) -> list[Attempt]:
        return [Attempt(proposal.named, first.poses, "") for proposal, _ in batch]

    for _ in grow(tree, settings, accept_all, calls):
        if len(tree.candidates) // 500 != (marks[-1][0] // 500 if marks else 0):
            marks.append((len(tree.candidates), len(calls), time.perf_counter()))
    cost = {b[0] // 500 * 500: (b[2] - a[2]) / (b[1] - a[1]) * 1e6 for a, b in pairwise(marks)}
    early, late = cost[1500], cost[10_500]
    note = "ours: 10,000 to 10,500 candidates; baseline: 1,000 to 1,500; aim: ratio above 1 / 1.2"
    yield figure("RRT call outside its attempt", late, early, "us", note)


def main() -> None:
    """Run the parts that are asked for and write build/bench.json."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--design", default="clay")
    parser.add_argument("--build", type=Path, default=Path("build"))
    parser.add_argument("--calls", type=int, default=40, help="RRT calls that are attempted")
    parser.add_argument("--paths", type=int, default=6, help="candidates whose paths are traced")
    options = parser.parse_args()
    bench = workbench(options.design, options.build)
    tree = grown_tree(bench, 200)
    some = tree.candidates[:: len(tree.candidates) // options.paths][: options.paths]
    figures = [
        *attempts(bench, tree, options.calls, options.build / ".kernels"),
        *paths(bench, some),
        *programs(bench, some[:3]),
        *tree_cost(bench, tree.candidates[0]),
    ]
    print_figures(figures)
    write_figures(figures, options.build / "bench.json")


main()
