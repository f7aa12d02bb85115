"""The command of benchmarks/paper_experiments.py."""

from __future__ import annotations

import argparse
from importlib.util import find_spec
from pathlib import Path

from benchmarks.paper.control import examine_groups
from benchmarks.paper.document import write_document
from benchmarks.paper.experiment import ROOT, Experiment, run_experiment
from benchmarks.paper.packing import Filling, fill_box
from benchmarks.paper.pictures import draw_curves
from benchmarks.paper.published import FULL, PLANE
from benchmarks.paper.recheck import recheck
from benchmarks.paper.recheck_command import HANDS, IPOPT_HANDS
from benchmarks.paper.recheck_ipopt import compare_with_ipopt
from benchmarks.paper.results import Results, outcome
from fpcad.commands.console import ConsoleReporter
from fpcad.pipeline.stage import Build, Reporter
from fpcad.spec.load import load_spec
from fpcad.store import write_whole
from fpcad.workers import available_cores

CONTROL_HANDS = 500
STEPS = (0.0334, 0.035, 0.05, 0.1, 1.0)
"""Longest steps towards a sample; below the least distance nothing could be accepted, 1 is no limit."""

PLANE_EXPERIMENT = Experiment("paper-2d", "2D, ours")
CALLS_EXPERIMENT = Experiment(
    "paper-2d",
    f"2D, ours, {PLANE.calls:,} calls",
    "-calls",
    {"min_efficiency": 0.0, "max_calls": PLANE.calls},
)
FULL_EXPERIMENT = Experiment("paper-6d", "6D, ours")


def main() -> None:
    """Run or reuse the builds, examine them and write the document."""
    told = _arguments()
    builds, reporter = told.build.resolve(), ConsoleReporter()
    picture = _picture(reporter)
    folders = [
        run_experiment(experiment.spec(told.candidates), builds, told.workers)
        for experiment in (PLANE_EXPERIMENT, CALLS_EXPERIMENT, FULL_EXPERIMENT)
    ]
    full = folders[-1]
    build = Build(load_spec(full / "spec.yaml"), full, told.workers, reporter=reporter)
    results = Results(
        plane=outcome(PLANE_EXPERIMENT, PLANE, folders[0]),
        plane_calls=outcome(CALLS_EXPERIMENT, PLANE, folders[1]),
        full=outcome(FULL_EXPERIMENT, FULL, full),
        fillings=_fillings(reporter),
        control=examine_groups(build, told.control),
        recheck=_recheck(full, told.recheck, reporter),
        ipopt=compare_with_ipopt(build, told.ipopt),
        trial=told.candidates,
    )
    folder = ROOT / "docs" if told.candidates is None else full
    if picture is not None:
        draw_curves(results, folder / picture)
    print(write_whole(folder / "results.md", write_document(results, picture)))


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=Path, default=ROOT / "build", help="folder of the builds")
    parser.add_argument(
        "--candidates",
        type=int,
        help="stop at this number: a trial with builds and a document of its own in --build",
    )
    parser.add_argument("--workers", type=int, default=available_cores())
    parser.add_argument("--control", type=int, default=CONTROL_HANDS, help="hands of each group")
    parser.add_argument("--recheck", type=int, default=HANDS, help="hands checked again")
    parser.add_argument("--ipopt", type=int, default=IPOPT_HANDS, help="hands given to IPOPT")
    return parser.parse_args()


def _picture(reporter: Reporter) -> str | None:
    """File of the curves beside the document; None, which is told at once, without matplotlib."""
    if find_spec("matplotlib") is None:
        reporter.note("no picture of the curves: matplotlib is missing; fpcad[pictures] brings it")
        return None
    return "images/results-curves.png"


def _fillings(reporter: Reporter) -> list[Filling]:
    """The sampling rule alone, with several steps."""
    settings, found = PLANE_EXPERIMENT.spec(None).sampling, []
    with reporter.stage("filling a free box", len(STEPS)) as bar:
        for step in STEPS:
            found.append(fill_box(settings.model_copy(update={"step": step}), PLANE.calls))
            bar.advance(1, f"step {step:g}")
    return found


def _recheck(folder: Path, count: int, reporter: Reporter):
    with reporter.stage(f"checking {count} hands again", None):
        return recheck(folder, count)
