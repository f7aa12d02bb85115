"""Verbs that run the stages of the pipeline, each up to its own."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from fpcad.commands.console import ConsoleReporter
from fpcad.commands.options import AsJson, BuildFolder, Design, Force, WorkerCount, spec_file
from fpcad.commands.summary import print_design
from fpcad.spec import Spec, load_spec

if TYPE_CHECKING:
    from fpcad.pipeline.hire import Hire

verbs = typer.Typer()

Verb = Literal["solve", "sample", "evaluate", "select", "export", "report"]

Scheduler = Annotated[
    str | None,
    typer.Option(metavar="ADDRESS", help="Run on a dask scheduler's workers: tcp://host:8786."),
]
Slurm = Annotated[
    bool, typer.Option("--slurm", help="Run on SLURM jobs of one core, as many as --workers says.")
]


def _here(last: Verb, told: str) -> Callable[..., None]:
    """A verb that runs the stages up to `last` on this machine's cores."""

    def command(
        name: Design,
        build: BuildFolder = Path("build"),
        workers: WorkerCount = 0,
        force: Force = False,
        as_json: AsJson = False,
    ) -> None:
        _run(last, name, build, workers, force, as_json)

    command.__doc__ = told
    return command


def _anywhere(last: Verb, told: str) -> Callable[..., None]:
    """A verb whose long stages may run on other machines too."""

    def command(
        name: Design,
        build: BuildFolder = Path("build"),
        workers: WorkerCount = 0,
        scheduler: Scheduler = None,
        slurm: Slurm = False,
        force: Force = False,
        as_json: AsJson = False,
    ) -> None:
        _run(last, name, build, workers, force, as_json, scheduler, slurm)

    command.__doc__ = told
    return command


def _export(
    name: Design,
    build: BuildFolder = Path("build"),
    workers: WorkerCount = 0,
    finger: Annotated[
        str | None, typer.Option(metavar="NAME", help="Write one finger's print files too, to try.")
    ] = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Write the chosen hand's parts, URDF, transmission, trajectories."""
    _run("export", name, build, workers, force, as_json)
    if finger is not None:
        from fpcad.pipeline.finished import export_finger

        folder = export_finger(build / load_spec(spec_file(name)).name, finger)
        typer.echo(f"{folder}: the parts of {finger} alone, with a mount for a vice", err=as_json)


STAGE_VERBS: dict[str, Callable[..., None]] = {
    "design": _anywhere(
        "report", "Make the whole hand: solve, sample, evaluate, select, export, report."
    ),
    "solve": _here("solve", "Solve the foundational poses of the first hand."),
    "sample": _anywhere(
        "sample", "Sample hands that reach all poses: candidates.parquet, calls.parquet."
    ),
    "evaluate": _anywhere("evaluate", "Trace each candidate's wielding paths and measure them."),
    "select": _here(
        "select",
        "Score the candidates and choose one: metrics.parquet, paths.parquet, selected.json.",
    ),
    "export": _export,
}
for _verb, _command in STAGE_VERBS.items():
    verbs.command(_verb)(_command)


def _run(
    last: Verb,
    name: str,
    folder: Path,
    workers: int,
    force: bool,
    as_json: bool,
    scheduler: str | None = None,
    slurm: bool = False,
) -> None:
    from fpcad.pipeline import Build, run_stages
    from fpcad.workers import available_cores

    spec: Spec = load_spec(spec_file(name))
    count = workers or available_cores()
    with _hiring(scheduler, slurm, count) as hire:
        build = Build(spec, folder / spec.name, count, ConsoleReporter(), hire=hire)
        manifest: dict[str, Any] = run_stages(build, last, force)
    if as_json:
        typer.echo(json.dumps(manifest, indent=2))
    else:
        print_design(build.folder, manifest, last)


def _hiring(scheduler: str | None, slurm: bool, count: int) -> AbstractContextManager[Hire]:
    """Where the workers come from; they are let go with the block."""
    from fpcad.pipeline.hire import on_scheduler, on_slurm, processes

    if scheduler and slurm:
        raise typer.BadParameter("--scheduler and --slurm exclude each other")
    if slurm:
        return on_slurm(count)
    return on_scheduler(scheduler) if scheduler else nullcontext(processes)
