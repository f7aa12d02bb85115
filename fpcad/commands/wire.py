"""Running trajectories on motors."""

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

DriverName = Annotated[
    str,
    typer.Option(
        "--driver",
        help="What the motors are: `fw` a controller with fpcad's firmware, `dynamixel` or `feetech` "
        "servos on a bus, `sim` simulated motors.",
    ),
]
Port = Annotated[
    str | None,
    typer.Option(
        help="Serial port, as /dev/ttyUSB0. For the driver fw also `sim`, a simulated controller, "
        "or `fw`, the firmware with simulated motors; `sim:20` is 20 times as fast."
    ),
]
CalibrationFile = Annotated[
    Path | None,
    typer.Option(
        "--calibration", metavar="FILE", help="Measured zeros; calibration/NAME.yaml by the design."
    ),
]


@verbs.command("run-trajectory")
def run_trajectory(
    name: Design,
    pose: Annotated[str, typer.Option(help="Pose whose trajectory is run.")],
    driver: DriverName = "fw",
    port: Port = None,
    build: BuildFolder = Path("build"),
    speed: Annotated[float, typer.Option(min=0.01, max=1.0, help="Factor of the speed.")] = 1.0,
    loop: Annotated[int, typer.Option(min=1, help="How often to run it.")] = 1,
    to_start: Annotated[
        bool, typer.Option("--to-start", help="Go to the first posture slowly, however far.")
    ] = False,
    wait_for_tool: Annotated[
        bool,
        typer.Option(
            "--wait-for-tool", help="Wait at the start, hand open, until the tool is put in."
        ),
    ] = False,
    clear: Annotated[bool, typer.Option("--clear", help="Unlatch a held controller.")] = False,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Check only, send nothing.")] = False,
    log: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE", help="Table of all telemetry, .csv or .parquet; else build/NAME/runs/."
        ),
    ] = None,
    calibration: CalibrationFile = None,
    as_json: AsJson = False,
) -> None:
    """Run a trajectory on the hand and report how well it was followed.

    It is checked whole before a port is opened. Ctrl-C slows down along the path and holds; twice
    turns the torque off, and the tool drops.
    """
    from fpcad.commands import drive
    from fpcad.run.hand_files import read_hand
    from fpcad.run.run_trajectory import RunOptions

    design = spec_file(name)
    spec = load_spec(design)
    drive.known_driver(driver)
    tool_in = drive.enter_pressed("Put the tool in, then hit Enter.") if wait_for_tool else None
    options = RunOptions(speed, loop, to_start, clear, log, tool_in=tool_in)
    file = drive.trajectory_file(build / spec.name, pose)
    hand = read_hand(spec, build / spec.name)
    if dry_run:
        report = drive.check(hand, file, options)
    else:
        kept = calibration or drive.calibration_of(design, hand, driver, port)
        report = drive.drive(hand, pose, driver, port, kept, options)
    if as_json:
        typer.echo(json.dumps(asdict(report), indent=2))
    else:
        print_run(report)
