"""Trials of many hands, one file of results a hand, so that a run can be stopped and gone on with."""

from __future__ import annotations

import time
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq

from fpcad.model.geometry import hand_geometry
from fpcad.pipeline.evaluate import evaluate_candidate
from fpcad.pipeline.sample import read_candidates
from fpcad.pipeline.stage import Build
from fpcad.sample.space import DesignSpace, design_space
from fpcad.sample.tree import Candidate
from fpcad.simulate.candidate import plain_hand, trajectories
from fpcad.simulate.trials import judge, run_trial, standard_trials
from fpcad.solve.attempt import Workbench
from fpcad.store import write_json


def run(build: Build, hands: int, out: Path, time_step_s: float, seed: int) -> None:
    """Try the hands of a build that wield in all poses, in an order drawn by the seed."""
    todo = [c for c in _chosen(build, hands, seed) if not (out / f"{c.id}.json").is_file()]
    task = partial(try_hand, design_space(build.spec.hand), time_step_s)
    with (
        build.open_workers() as workers,
        build.reporter.stage("physics", len(todo)) as bar,
    ):
        for result in workers.map(task, todo):
            write_json(out / f"{result['id']}.json", result)
            bar.advance(1, f"hand {result['id']}: {result['seconds']:.0f} s")


def try_hand(
    space: DesignSpace, time_step_s: float, bench: Workbench, candidate: Candidate
) -> dict[str, Any]:
    """All trials of one hand, as plain values."""
    started = time.perf_counter()
    evaluation = evaluate_candidate(space, bench, candidate)
    design = space.internal(candidate.named)
    geometry = hand_geometry(bench.template, design)
    made, faults = trajectories(bench, design, geometry, evaluation.paths)
    hand = plain_hand(bench.spec, geometry, {pose: moving for pose, (moving, _) in made.items()})
    poses = {}
    for pose, (trajectory, margins) in made.items():
        metrics = asdict(evaluation.metrics[pose])
        trials = {}
        for name, trial in standard_trials(bench.spec, pose, metrics["tip_force_n"]).items():
            stepped = type(trial)(**{**asdict(trial), "time_step_s": time_step_s})
            record = run_trial(hand, bench.spec, pose, trajectory, stepped)
            told = judge(bench.spec, pose, trajectory, record)
            trials[name] = told.as_values() | {"simulated_s": record.seconds}
        poses[pose] = {"metrics": metrics, "margins": asdict(margins), "trials": trials}
    seconds = time.perf_counter() - started
    return {"id": candidate.id, "poses": poses, "faults": faults, "seconds": seconds}


def _chosen(build: Build, hands: int, seed: int) -> list[Candidate]:
    """Candidates that the evaluation found to wield in all poses, in a drawn order."""
    rows = pq.read_table(build.folder / "store" / "metrics.parquet").to_pylist()
    wielding = {row["id"] for row in rows if all(row[f"{p}_tmr_deg"] > 0 for p in build.spec.poses)}
    there = [c for c in read_candidates(build) if c.id in wielding]
    order = np.random.default_rng(seed).permutation(len(there))
    return [there[i] for i in order[:hands]]
