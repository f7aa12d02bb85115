"""docs/results.md: our numbers beside the paper's, written from the tables alone."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from benchmarks.paper.document_control import control_section
from benchmarks.paper.document_reasons import reasons_section
from benchmarks.paper.machine import describe_machine
from benchmarks.paper.markdown import share, table
from benchmarks.paper.recheck_command import ipopt_section, residual_section
from benchmarks.paper.results import Outcome, Results
from benchmarks.paper.tally import METRICS, QUANTILES, THRESHOLDS_DEG
from benchmarks.physics_hypothesis.summary import IN_RESULTS, physics_section
from fpcad.sample.rrt import ACCEPTED

CHECKPOINTS = (100, 200, 500, 1_000, 2_000, 5_000, 10_000, 20_000, 50_000, 100_000)
MB = 1e6
PHYSICS_PAGE = Path(__file__).parents[2] / "docs" / "physics-hypothesis.md"


def write_document(results: Results, picture: str | None) -> str:
    """The whole document; `picture` is a file beside it, if there is one."""
    parts = [
        "# The paper's two experiments",
        _introduction(results),
        *(
            ["![Efficiency and share of hands beyond a motion range](" + picture + ")"]
            if picture
            else []
        ),
        "## Beside the paper",
        _comparison(results),
        reasons_section(results),
        "## Efficiency along the run",
        _efficiency_curve(results),
        "## Hands whose tool motion range is above a threshold",
        _threshold_curves(results),
        "## Why paths end",
        _path_ends(results),
        "## Why calls fail",
        _rejections(results),
        "## Metrics",
        _metrics(results),
        "## What it took",
        _costs(results),
        "## Control group",
        control_section(results.control),
        "## Accepted poses checked again",
        residual_section(results.recheck),
        ipopt_section(dict(results.ipopt)),
        IN_RESULTS,
        physics_section(PHYSICS_PAGE.read_text(encoding="utf-8")),
    ]
    return "\n\n".join(parts) + "\n"


def _introduction(results: Results) -> str:
    trial = (
        f"**A trial with at most {results.trial:,} candidates, not the experiments themselves.** "
        if results.trial
        else ""
    )
    return (
        f"{trial}Written by `benchmarks/paper_experiments.py` on "
        f"{datetime.now(UTC).date()}; every number comes from the tables of the builds of "
        "`designs/paper-2d.yaml` and `designs/paper-6d.yaml`, and anyone can run it again:\n\n"
        "    .venv/bin/python benchmarks/paper_experiments.py\n\n"
        f"Machine: {describe_machine()}. Versions: {_versions(results.full)}.\n\n"
        "The paper is Wang, Oh, Pollard, *The Foundational Pose as a Selection Mechanism for the Design of "
        "Tool-Wielding Multi-Finger Robotic Hands*. Its tool, ranges, contact windows and start are not published, "
        "so the figures beside ours are those of another hand family; they were not tuned to.\n\n"
        "A candidate is a hand that reaches all poses and is held in them. TMR is the tool's motion range, greater "
        "than zero where a path makes at least one full step of 1 deg. Efficiency is candidates / calls [paper]."
    )


def _versions(outcome: Outcome) -> str:
    return ", ".join(f"{name} {version}" for name, version in outcome.costs.versions.items())


def _comparison(results: Results) -> str:
    plane, calls, full = results.outcomes
    headings = ("", "2D, paper", plane.title, calls.title, "6D, paper", full.title)
    columns = [_published(plane), _ours(plane), _ours(calls), _published(full), _ours(full)]
    rows = [(name, *(column[name] for column in columns)) for name in columns[0]]
    return table(headings, rows)


def _published(outcome: Outcome) -> dict[str, str]:
    paper = outcome.published
    return {
        "candidates": f"{paper.candidates:,}",
        "calls": f"{paper.calls:,}",
        "efficiency, all calls": f"{paper.efficiency:.2%}",
        "efficiency, last 1,000 calls": "not told",
        "occupied volume": _percent(paper.occupied),
        **{f"TMR > 0, {pose}": f"{value:.2%}" for pose, value in paper.wielding.items()},
        "on the Pareto front": "not told",
    }


def _ours(outcome: Outcome) -> dict[str, str]:
    t = outcome.tally
    return {
        "candidates": f"{t.candidates:,}",
        "calls": f"{t.calls:,}",
        "efficiency, all calls": f"{t.efficiency:.2%}",
        "efficiency, last 1,000 calls": f"{t.last_efficiency:.2%}",
        "occupied volume": _percent(t.occupied),
        **{f"TMR > 0, {p}": share(t.beyond(p, 0), t.candidates) for p in t.tmr_deg},
        "on the Pareto front": f"{t.front:,}",
    }


def _percent(value: float) -> str:
    return f"{value:.1%}" if value > 1e-3 else f"{100 * value:.2e} %"


def _efficiency_curve(results: Results) -> str:
    tallies = [results.plane_calls.tally, results.full.tally]
    longest = max(t.calls for t in tallies)
    points = sorted({*(c for c in CHECKPOINTS if c < longest), *(t.calls for t in tallies)})
    rows = []
    for calls in points:
        pairs = [t.efficiency_after(calls) if calls <= t.calls else None for t in tallies]
        shown = [f"{value:.1%}" if pair else "" for pair in pairs for value in pair or (0, 0)]
        rows.append((f"{calls:,}", *shown))
    window = results.full.tally.spec.sampling.efficiency_window
    headings = ("calls", "2D, all", f"2D, last {window:,}", "6D, all", f"6D, last {window:,}")
    return table(headings, rows)


def _threshold_curves(results: Results) -> str:
    chosen = (results.plane, results.full)
    poses = list(chosen[0].tally.tmr_deg)
    headings = ("TMR above [deg]", *(f"{o.title}, {p}" for o in chosen for p in poses))
    rows = [
        (t, *(f"{o.tally.beyond(p, t) / o.tally.candidates:.1%}" for o in chosen for p in poses))
        for t in THRESHOLDS_DEG
    ]
    return table(headings, rows)


def _path_ends(results: Results) -> str:
    """All ends, and those of paths without motion."""
    chosen = (results.plane, results.full)
    reasons = sorted({reason for o in chosen for ends in o.tally.ends.values() for reason in ends})
    poses = list(chosen[0].tally.ends)
    headings = ("end", *(f"{o.title}, {p}" for o in chosen for p in poses))
    rows = [
        (
            reason,
            *(
                f"{o.tally.ends[p][reason] / (2 * o.tally.candidates):.1%}"
                for o in chosen
                for p in poses
            ),
        )
        for reason in reasons
    ]
    return "\n\n".join(
        [
            "Each path has two ends. `statics`: no equilibrium within the torque cap; `limits`: the rate program "
            "has no solution, that is joint limits, contact bounds or collision; `complete`: half a turn.",
            table(headings, rows),
            _failures(chosen),
        ]
    )


def _failures(chosen: tuple[Outcome, ...]) -> str:
    rows = [
        (o.title, pose, minus, plus, f"{count:,}")
        for o in chosen
        for pose, ends in o.tally.failures.items()
        for (minus, plus), count in ends.most_common()
    ]
    if not rows:
        return "No candidate of either experiment failed to move its tool."
    headings = ("experiment", "pose", "end, minus side", "end, plus side", "candidates")
    return "The candidates with TMR = 0:\n\n" + table(headings, rows)


def _rejections(results: Results) -> str:
    outcomes = results.outcomes
    kinds = sorted({kind for o in outcomes for kind in o.tally.outcomes})
    kinds.sort(key=lambda kind: -max(o.tally.outcomes[kind] / o.tally.calls for o in outcomes))
    rows = [(k, *(share(o.tally.outcomes[k], o.tally.calls, 1) for o in outcomes)) for k in kinds]
    return "\n\n".join(
        [
            f"Every call has one outcome: `{ACCEPTED}`, `too close` to a candidate, `geometry` (roots overlap), "
            "`POSE: solve` (not reached), `POSE: statics` (reached, not held). The first failure is told, "
            "solves before statics and poses in the spec's order.",
            table(("outcome", *(o.title for o in outcomes)), rows),
        ]
    )


def _metrics(results: Results) -> str:
    names = {"tmr_deg": "TMR [deg]", "mss_mm_s": "MSS [mm/s]", "mft_p90_nmm": "MFT, p90 [N mm]"}
    rows = []
    for o in (results.plane, results.full):
        for pose in o.tally.ends:
            told = [o.tally.quantiles(pose, m) for m in METRICS]
            rows.append((o.title, pose, *(" / ".join(f"{v:.3g}" for v in q) for q in told)))
    quantiles = " / ".join(f"{q:.0%}" for q in QUANTILES)
    headings = ("experiment", "pose", *(f"{names[m]}" for m in METRICS))
    return f"Quantiles {quantiles} over the candidates with a path.\n\n" + table(headings, rows)


def _costs(results: Results) -> str:
    rows = [_cost_row(outcome) for outcome in results.outcomes]
    stages = list(results.full.costs.stage_seconds)
    headings = (
        "experiment",
        *(f"{stage} [s]" for stage in stages),
        "wall time [s]",
        "workers",
        "peak, main [MB]",
        "peak, a worker [MB]",
        "tables [MB]",
        "with shards [MB]",
    )
    return "\n\n".join(
        [
            "Seconds of the stages, and of the whole command where this script ran it; peak resident memory of the "
            "command's process and of its largest worker. Compiling the formulas is in `solve`, once a spec.",
            table(headings, rows),
        ]
    )


def _cost_row(outcome: Outcome) -> tuple[str, ...]:
    costs = outcome.costs
    tables = sum(size for name, size in costs.size_bytes.items() if name != "store/")
    size = (f"{tables / MB:.1f}", f"{sum(costs.size_bytes.values()) / MB:.1f}")
    seconds = (f"{value:.0f}" for value in costs.stage_seconds.values())
    if not costs.runs:
        return (outcome.title, *seconds, *["not measured"] * 4, *size)
    wall = sum(run["seconds"] for run in costs.runs)
    peaks = (int(np.max([run[key] for run in costs.runs])) for key in ("main_mb", "worker_mb"))
    workers = ", ".join(sorted({str(run["workers"]) for run in costs.runs}))
    return (outcome.title, *seconds, f"{wall:.0f}", workers, *map(str, peaks), *size)
