import shutil

import numpy as np
import pytest

from benchmarks.paper import control
from benchmarks.paper.control import directions_held, examine
from benchmarks.paper.control_states import (
    Disturbed,
    Subject,
    own_states,
    reattempted_states,
    without_tip_force,
)
from benchmarks.paper.recheck_ipopt import ipopt_costs, open_references
from fpcad.pipeline.stage import Build
from fpcad.sample.tree import Candidate
from fpcad.solve.attempt import held
from fpcad.solve.measure import measure
from fpcad.solve.program import pose_bounds
from fpcad.wield.evaluate import evaluate
from fpcad.wield.rates import End
from fpcad.workers import InProcess


@pytest.fixture(scope="module")
def subject(first_hand):
    return Subject(0, first_hand.named, first_hand.states)


def test_without_a_tip_force_nothing_ends_by_statics(bench, first_hand):
    metrics = evaluate(without_tip_force(bench), first_hand.design, first_hand.states).metrics
    ends = {end for m in metrics.values() for end in (m.end_minus, m.end_plus)}
    assert End.STATICS not in ends


def test_a_candidate_is_held_both_ways_and_turns_further_without_statics(
    bench, clay_space, subject
):
    rows = examine(own_states, clay_space, bench, subject)
    assert [row["pose"] for row in rows] == list(bench.spec.poses)
    assert all(row["held"] == 2 and row["moved"] == 0.0 for row in rows)
    assert all(0 < row["tmr_on_deg"] <= row["tmr_off_deg"] for row in rows)


def test_a_hand_is_reattempted_as_it_was(bench, clay_space, subject, first_hand):
    again = reattempted_states(bench, clay_space, subject)
    assert again is not None and set(again) == set(first_hand.states)


@pytest.mark.parametrize("size", [0.1, 0.3])
def test_disturbed_poses_keep_all_constraints_and_lose_the_optimum(
    bench, clay_space, subject, first_hand, size
):
    states = Disturbed(size)(bench, clay_space, subject)
    assert states is not None
    for pose, y in states.items():
        kernels, design = bench.kernels[pose], first_hand.design
        bounds = pose_bounds(bench.spec, pose, kernels.layout)
        assert measure(kernels, design, 0.0, y, bounds).acceptable
        residuals = kernels.constraints(design, 0.0, y)[0].copy()
        assert residuals @ residuals > first_hand.attempt.poses[pose].cost
        assert (directions_held(bench, pose, design, y) == 2) == held(bench, pose, design, y)


def test_a_disturbance_depends_on_the_hand_alone(bench, clay_space, subject):
    first, again = (Disturbed(0.1)(bench, clay_space, subject) for _ in range(2))
    assert first is not None and again is not None
    assert all(np.array_equal(first[pose], again[pose]) for pose in first)


def test_ipopt_finds_no_other_pose_for_the_first_hand(
    bench, clay, clay_space, kernel_cache, first_hand
):
    solver = clay.solver.model_copy(update={"method": "ipopt"})
    benches = open_references(clay.model_copy(update={"solver": solver}), kernel_cache)
    hand = Candidate(0, -1, first_hand.named, first_hand.attempt.poses)
    costs = ipopt_costs(clay_space, benches, hand)
    for pose, cost in costs.items():
        if cost is not None:
            ours = first_hand.attempt.poses[pose].cost
            assert ours <= cost + max(0.01 * abs(cost), 2e-3)
    assert sum(cost is not None for cost in costs.values()) >= 2


def refuse(*_):
    raise AssertionError("examined again")


class BuildInProcess(Build):
    def open_workers(self):
        return InProcess(lambda: self.bench)


def test_finished_chunks_are_not_examined_again(
    built_clay, kernel_cache, clay, tmp_path, monkeypatch
):
    folder = tmp_path / "clay"
    folder.mkdir()
    for name in ("candidates.parquet", "calls.parquet", "manifest.json"):
        shutil.copy(built_clay / name, folder)
    (tmp_path / ".kernels").symlink_to(kernel_cache, target_is_directory=True)
    build = BuildInProcess(clay, folder)
    first = control.examine_groups(build, 1)
    monkeypatch.setattr(control, "examine", refuse)
    assert control.examine_groups(build, 1) == first
    assert {row["pose"] for row in first["candidates"]} == set(clay.poses)
    assert all(row["held"] == 2 for row in first["candidates"])
