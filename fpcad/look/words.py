"""The summary of a run in words and small tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fpcad.look.built import (
    SHOWN_LOADS,
    Row,
    check_warnings,
    checks,
    load_warnings,
    loads,
    parts_list,
    refusals,
    torque_warnings,
)
from fpcad.look.columns import Column
from fpcad.look.curves import outcome_counts
from fpcad.look.logs import RunLog
from fpcad.look.run import Run
from fpcad.select.columns import flags, numbers
from fpcad.spec.pose import Pose

NO_VALUE = "no path"
UNITS_OF_DIGITS = {"N mm": 0, "mm/s": 2, "N": 2}


@dataclass(frozen=True)
class Chosen:
    """The chosen hand in words."""

    id: int
    reason: str
    design: list[tuple[str, str]]
    headings: list[str]
    """Kinds of metrics and scores."""
    rows: list[tuple[str, list[str]]]
    """Each pose with its metrics and scores."""
    mean: str


@dataclass(frozen=True)
class Summary:
    """What the top of the page says."""

    title: str
    description: str
    spec: list[tuple[str, str]]
    """Facts of the spec: subject and sentence."""
    run: list[tuple[str, str]]
    """Facts of the run: subject and sentence."""
    chosen: Chosen | None
    refusals: list[tuple[str, int, list[int]]]
    """Why hands cannot be made, how many, and the first of them."""
    parts: list[Row]
    """Rows of the parts list."""
    checks: list[Row]
    """What the gates found on the chosen hand."""
    loads: list[Row]
    """What its parts bear along the trajectories, the heaviest shares."""
    load_count: int
    """How many there are in all."""
    logs: list[tuple[str, tuple[tuple[str, str], ...]]]
    """Runs on motors with their facts."""
    warnings: list[str]


def summarize(
    run: Run, document: dict[str, Any], logs: Sequence[RunLog] = (), more: Sequence[str] = ()
) -> Summary:
    """The summary of a run and of what its page leaves out; `more` are warnings to add."""
    told = (*load_warnings(run), *torque_warnings(run), *check_warnings(run))
    warnings = [*run.warnings, *told, *more]
    if left_out := document["thin"]["left_out"]:
        warnings.append(f"{left_out} hands of the front are on this page without their paths.")
    return Summary(
        title=run.spec.name,
        description=run.spec.description,
        spec=spec_facts(run),
        run=run_facts(run),
        chosen=_chosen(run),
        refusals=refusals(run),
        parts=parts_list(run),
        checks=checks(run),
        loads=loads(run)[:SHOWN_LOADS],
        load_count=len(loads(run)),
        logs=[(log.name, log.facts) for log in logs],
        warnings=warnings,
    )


def spec_facts(run: Run) -> list[tuple[str, str]]:
    """The spec in sentences."""
    spec, tool = run.spec, run.spec.tool
    free = [c for c, is_free in zip(run.parameters, run.space.free, strict=True) if is_free]
    ranges = ", ".join(_range(run, column) for column in free) or "none"
    facts = [
        (
            "Tool",
            f"{tool.shape} of radius {tool.radius_mm:g} mm, from {tool.back_mm:g} to {tool.tip_mm:g} mm",
        ),
        ("Hand", f"{spec.hand.template}, fingers {spec.hand.finger_length_mm:g} mm long"),
        ("Free parameters", ranges),
        *((f"Pose {name}", _pose(pose)) for name, pose in spec.poses.items()),
        (
            "Statics",
            f"friction {spec.statics.friction:g}, at most "
            f"{spec.statics.max_joint_torque_nmm / 1000:g} N m a joint",
        ),
        ("Motors", spec.motors.type),
    ]
    return facts


def run_facts(run: Run) -> list[tuple[str, str]]:
    """Counts of the run in sentences."""
    n, calls = run.candidates.num_rows, run.calls.num_rows
    accepted = sum(outcome == "accepted" for outcome in run.calls["outcome"].to_pylist())
    efficiency = f", {accepted / calls:.1%} of them accepted" if calls else ""
    outcomes = ", ".join(f"{name} {count}" for name, count in outcome_counts(run).items())
    facts = [
        (
            "Candidates",
            f"{n} of {run.spec.sampling.candidates} asked for, seed {run.spec.sampling.seed}",
        ),
        ("Calls", f"{calls}{efficiency}" + (f" ({outcomes})" if outcomes else "")),
        (
            "Measured",
            f"{run.metrics.num_rows} candidates, {int(run.front.sum())} on the Pareto front",
        ),
    ]
    if run.metrics.num_rows:
        facts.append(("Wielding", _wielding(run)))
        facts.append(("Makeable", _makeable(run)))
    return facts


def _wielding(run: Run) -> str:
    """Shares of hands that turn the tool, for each pose and for all of them."""
    moves = [numbers(run.metrics, f"{pose}_tmr_deg") > 0 for pose in run.poses]
    shares = [f"{pose} {m.mean():.1%}" for pose, m in zip(run.poses, moves, strict=True)]
    every = np.all(moves, axis=0)
    return f"tool turned from all poses by {every.mean():.1%} of the hands ({', '.join(shares)})"


def _makeable(run: Run) -> str:
    """How many hands nothing is known against."""
    refused = run.metrics.num_rows - int(flags(run.metrics, "makeable").sum())
    return f"{refused} hands are refused" if refused else "no hand is refused"


def _range(run: Run, column: Column) -> str:
    index = run.space.names.index(column.name)
    low, high = run.space.lower[index], run.space.upper[index]
    return f"{column.label} {low:g} to {high:g} {column.unit}"


def _pose(pose: Pose) -> str:
    touching = ", ".join(
        contact.finger if contact.link == "distal" else f"{contact.finger} ({contact.link})"
        for contact in pose.contacts
    )
    axis = " ".join(f"{value:g}" for value in pose.turning.axis)
    held = f"held against {pose.tip_force_n:g} N at the tip"
    described = f"{pose.description} " if pose.description else ""
    return f"{described}Touched by {touching}; turned about ({axis}), {held}."


def _chosen(run: Run) -> Chosen | None:
    if run.selected is None:
        return None
    row = next((r for r in run.metrics.to_pylist() if r["id"] == run.selected["id"]), None)
    if row is None:
        return None
    first = run.poses[0]
    columns = [
        *(c for c in run.metric_columns if c.pose == first),
        *(c for c in run.score_columns if c.pose == first),
    ]
    rows = []
    for pose in run.poses:
        same = [Column(pose + c.name[len(first) :], c.label, c.unit) for c in columns]
        rows.append((pose, [_value(row.get(c.name), c) for c in same]))
    design = [(c.label, _value(run.selected["design"][c.name], c, True)) for c in run.parameters]
    return Chosen(
        id=int(run.selected["id"]),
        reason=run.selected["reason"],
        design=design,
        headings=[_heading(c, first) for c in columns],
        rows=rows,
        mean=f"{row['mean_score']:.1f}",
    )


def _heading(column: Column, pose: str) -> str:
    words = column.label.removeprefix(f"{pose}: ")
    if column.name.endswith("_score"):
        return f"score of {words}"
    return f"{words} [{column.unit}]" if column.unit else words


def _value(value: float | None, column: Column, with_unit: bool = False) -> str:
    if value is None or value != value:
        return NO_VALUE
    text = f"{value:.{UNITS_OF_DIGITS.get(column.unit, 1)}f}"
    return f"{text} {column.unit}" if with_unit else text
