"""Verbs that speak to motor controllers."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from fpcad.commands.options import AsJson, BuildFolder, Design, spec_file
from fpcad.commands.summary import print_run
from fpcad.spec import load_spec

verbs = typer.Typer()


@verbs.command("run-trajectory")
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
    from fpcad.commands.drive import drive

    spec = load_spec(spec_file(name))
    report = drive(spec, build / spec.name, pose, port, speed, loop, to_start, clear, dry_run, log)
    if as_json:
        typer.echo(json.dumps(asdict(report), indent=2))
    else:
        print_run(report)
