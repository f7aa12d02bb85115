"""The command line: one short function a verb."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer
from rich.markup import escape

from fpcad.console import ConsoleReporter, console, start_logging
from fpcad.errors import FpcadError, SpecError
from fpcad.spec import Spec, find_faults, json_schema, load_spec, write_new
from fpcad.summary import print_design, print_run

if TYPE_CHECKING:
    from fpcad.pipeline.hire import Hire

app = typer.Typer(
    name="fpcad",
    help=(
        "From one YAML file to a tool-wielding robotic hand on the wire.\n\n"
        "`fpcad new NAME` writes a spec to start from, `fpcad design NAME` makes the hand: it solves "
        "the foundational poses, samples designs, traces wielding paths, selects one hand and "
        "exports parts, URDF and trajectories to build/NAME. The stages are verbs of their own; "
        "each makes what it needs and skips what is up to date, and after an interruption goes on "
        "where it was."
    ),
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

DESIGNS = Path("designs")
INTERRUPTED = 130

Verb = Literal["solve", "sample", "evaluate", "select", "export", "report"]

Design = Annotated[
    str, typer.Argument(metavar="NAME", help="A design: `clay` for designs/clay.yaml, or a file.")
]
BuildFolder = Annotated[
    Path, typer.Option("--build", metavar="DIR", help="Folder for everything that is made.")
]
WorkerCount = Annotated[
    int,
    typer.Option("--workers", "-j", min=0, help="Processes side by side; 0: one for each core."),
]
Scheduler = Annotated[
    str | None,
    typer.Option(metavar="ADDRESS", help="Run on a dask scheduler's workers: tcp://host:8786."),
]
Slurm = Annotated[
    bool, typer.Option("--slurm", help="Run on SLURM jobs of one core, as many as --workers says.")
]
Force = Annotated[bool, typer.Option("--force", help="Make the last stage again.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print the result as JSON on stdout.")]


def _tell_version(asked: bool) -> None:
    if asked:
        typer.echo(f"fpcad {version('fpcad')}")
        raise typer.Exit


@app.callback()
def options(
    verbose: Annotated[
        int, typer.Option("--verbose", "-v", count=True, help="Log more; twice for everything.")
    ] = 0,
    show_version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_tell_version, is_eager=True, help="Tell the version and exit."
        ),
    ] = False,
) -> None:
    """Options that come before the verb."""
    start_logging(verbose)


@app.command()
def new(name: Annotated[str, typer.Argument(help="Name of the new design.")]) -> None:
    """Write designs/NAME.yaml, a commented spec to start from."""
    typer.echo(f"{write_new(name, DESIGNS)}: edit it, then run `fpcad design {name}`")


@app.command()
def validate(
    spec: Annotated[str, typer.Argument(metavar="SPEC", help="A design's name or file.")],
    as_json: AsJson = False,
) -> None:
    """Check a spec; tell all of its faults with their lines. Exit code 0 or 2."""
    faults = find_faults(spec_file(spec))
    if as_json:
        typer.echo(json.dumps([asdict(fault) for fault in faults], indent=2, default=str))
    elif faults:
        raise SpecError("\n".join(map(str, faults)))
    else:
        typer.echo(f"{spec_file(spec)}: valid")
    if faults:
        raise typer.Exit(SpecError.exit_code)


@app.command()
def schema() -> None:
    """Print the JSON schema of specs, for editors."""
    typer.echo(json.dumps(json_schema(), indent=2))


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
    "export": _here("export", "Write the chosen hand's parts, URDF, transmission, trajectories."),
}
for _verb, _command in STAGE_VERBS.items():
    app.command(_verb)(_command)


@app.command()
def report(name: Design, build: BuildFolder = Path("build")) -> None:
    """Write report.html, one page to look at a run with, finished or not."""
    from fpcad.look.report import write_report

    typer.echo(write_report(run_folder(name, build)))


@app.command()
def explore(
    name: Design,
    build: BuildFolder = Path("build"),
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port; 0 takes any free one.")] = 8765,
    host: Annotated[
        str, typer.Option(help="Address to listen at; this machine alone by default.")
    ] = "127.0.0.1",
    workers: WorkerCount = 0,
) -> None:
    """Look at all hands of a run with their paths in a browser, compare them, choose another one."""
    from fpcad.explore import explore_run

    explore_run(run_folder(name, build), host, port, workers)


@app.command()
def plot(
    name: Design,
    out: Annotated[Path, typer.Option(metavar="DIR", help="Folder for the figures.")],
    build: BuildFolder = Path("build"),
) -> None:
    """Write a run's figures as SVG and PDF, for a paper."""
    from fpcad.look.figures import write_figures
    from fpcad.look.run import load

    for file in write_figures(load(run_folder(name, build)), out):
        typer.echo(file)


@app.command()
def table(
    name: Design,
    build: BuildFolder = Path("build"),
    latex: Annotated[bool, typer.Option("--latex", help="LaTeX instead of CSV.")] = False,
    front: Annotated[bool, typer.Option("--front", help="Only the Pareto front.")] = False,
    columns: Annotated[
        str, typer.Option(metavar="A,B,...", help="Columns to print; all by default.")
    ] = "",
) -> None:
    """Print a run's hands as CSV or LaTeX, the best mean score first."""
    from fpcad.look.run import load
    from fpcad.look.tables import csv_text, hands, latex_text

    rows = hands(load(run_folder(name, build)), [c for c in columns.split(",") if c], front)
    typer.echo(latex_text(rows) if latex else csv_text(rows), nl=False)


@app.command("run-trajectory")
def run_trajectory(
    name: Design,
    pose: Annotated[str, typer.Option(help="Pose whose trajectory is run.")],
    port: Annotated[
        str,
        typer.Option(
            help="Serial port of the controller, as /dev/ttyUSB0; `sim` starts a simulated one, `fw` the firmware."
        ),
    ],
    build: BuildFolder = Path("build"),
    speed: Annotated[float, typer.Option(min=0.01, max=1.0, help="Factor of the speed.")] = 1.0,
    loop: Annotated[int, typer.Option(min=1, help="How often to run it.")] = 1,
    to_start: Annotated[
        bool, typer.Option("--to-start", help="Go to the first posture slowly, however far.")
    ] = False,
    clear: Annotated[bool, typer.Option("--clear", help="Unlatch a held controller.")] = False,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Check only, send nothing.")] = False,
    log: Annotated[
        Path | None, typer.Option(metavar="FILE", help="CSV file for all telemetry.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Stream a trajectory to the motor controllers and report how well it was followed.

    Ctrl-C slows down along the path and holds; twice turns the torque off, and the tool drops.
    """
    from fpcad.drive import drive

    spec = load_spec(spec_file(name))
    report = drive(spec, build / spec.name, pose, port, speed, loop, to_start, clear, dry_run, log)
    if as_json:
        typer.echo(json.dumps(asdict(report), indent=2))
    else:
        print_run(report)


def spec_file(name: str) -> Path:
    """File of a design that is given by name or by path."""
    named = DESIGNS / f"{name}.yaml"
    is_path = name.endswith((".yaml", ".yml")) or "/" in name
    return Path(name) if is_path else named


def run_folder(name: str, build: Path) -> Path:
    """Build folder of a design that is given by name, by spec file, or itself."""
    return Path(name) if (Path(name) / "manifest.json").is_file() else build / Path(name).stem


def main() -> None:
    """Entry point: errors become one message and an exit code."""
    try:
        app()
    except FpcadError as error:
        console.print(f"[red]error:[/red] {escape(str(error))}", soft_wrap=True, highlight=False)
        sys.exit(error.exit_code)
    except KeyboardInterrupt:
        console.print("interrupted; finished work is kept, the same command goes on")
        sys.exit(INTERRUPTED)


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
