"""From a build folder to a run: which files and which driver belong together."""

from __future__ import annotations

import math
import select
import sys
from collections.abc import Callable
from dataclasses import replace
from datetime import datetime
from pathlib import Path

import typer

from fpcad.commands.console import console
from fpcad.commands.live import live_joints
from fpcad.errors import StoreError
from fpcad.run import report as runs
from fpcad.run.calibration import Calibration, calibration_file, read_calibration
from fpcad.run.drivers.choose import (
    DRIVERS,
    Pace,
    guards_of,
    register_bus,
    simulated_bus,
    simulated_map,
)
from fpcad.run.errors import CalibrationError
from fpcad.run.hand_files import HandFiles
from fpcad.run.motor_map import MotorMap
from fpcad.run.plan import planned
from fpcad.run.preflight import preflight
from fpcad.run.run_trajectory import (
    SIMULATED_PORTS,
    DryRun,
    RunOptions,
    clock_rate,
    dry_run,
    run_on_servos,
    run_trajectory,
)


def drive(
    hand: HandFiles,
    pose: str,
    driver: str,
    port: str | None,
    calibration: Path,
    options: RunOptions,
) -> runs.RunReport:
    """Run one pose's trajectory of the hand; checked whole before a port is opened."""
    trajectory = trajectory_file(hand.folder, pose)
    check(hand, trajectory, options)
    if options.log is None:
        options = replace(options, log=log_file(hand.folder, pose))
    with live_joints(pose, hand.limits.names) as show:

        def progress(at: runs.Progress) -> None:
            note = f"{at.state}, error {math.degrees(at.error_rad):.2f} deg, {at.resends} resends"
            show(min(at.path_s, at.total_s), at.total_s, note, at.sample)

        pace = pace_of(driver, port)
        told = replace(options, on_progress=progress, motor_names=hand.motors)
        if driver == "fw":
            zeros = kept_zeros(hand, calibration, needed_port(driver, port))
            return run_trajectory(
                trajectory, hand.limits, needed_port(driver, port), zeros_rad=zeros, **vars(told)
            )
        if driver == "sim":
            start = planned(trajectory, hand.limits, 1.0, 1).position[0]
            bus, motors = simulated_bus(hand, start, pace), simulated_map(hand)
        else:
            bus = register_bus(driver, hand, needed_port(driver, port))
            motors = kept_map(hand, calibration, driver)
        return run_on_servos(
            trajectory, hand.limits, bus, motors, guards_of(hand, bus), told, pace.clock, pace.sleep
        )


def check(hand: HandFiles, trajectory: Path, options: RunOptions) -> DryRun:
    """All that can be known without a port: limits of joints and motors, torque, collision."""
    preflight(hand, planned(trajectory, hand.limits, options.speed, 1))
    return dry_run(trajectory, hand.limits, speed=options.speed, loops=options.loops)


def trajectory_file(folder: Path, pose: str) -> Path:
    """The trajectory of a pose; :class:`StoreError` tells which ones there are."""
    file = folder / "trajectories" / f"{pose}.json"
    if not file.is_file():
        there = ", ".join(sorted(f.stem for f in file.parent.glob("*.json")))
        advice = f"there are: {there}" if there else f"make them with `fpcad design {folder.name}`"
        raise StoreError(f"{folder}: no trajectory of a pose `{pose}`; {advice}")
    return file


def log_file(folder: Path, pose: str) -> Path:
    """Where a run leaves its table: `runs/POSE-TIME.parquet` in the build folder."""
    return folder / "runs" / f"{pose}-{datetime.now():%Y%m%d-%H%M%S}.parquet"


def known_driver(name: str) -> str:
    """The name of a driver, checked as an option's value."""
    if name not in DRIVERS:
        raise typer.BadParameter(f"{name} is none of {', '.join(DRIVERS)}")
    return name


def needed_port(driver: str, port: str | None) -> str:
    """A port, which all drivers but simulated motors need."""
    if port is None:
        raise typer.BadParameter(f"the driver {driver} needs --port; `fpcad ports` lists them")
    return port


def pace_of(driver: str, port: str | None) -> Pace:
    """Real time, but for simulated motors on a `--port` such as sim:20, which are hurried."""
    return Pace(clock_rate(port)) if driver == "sim" and port is not None else Pace()


def kept_map(hand: HandFiles, file: Path, driver: str) -> MotorMap:
    """Joints to motors as measured on the hand; servos are not moved without that."""
    return hand.motor_map(read_calibration(file, hand.motors, hand.limits, driver))


def kept_zeros(hand: HandFiles, file: Path, port: str):
    """Zeros for a controller that does not know them, if there are any; (n,) or None."""
    if port.partition(":")[0] in SIMULATED_PORTS or not file.is_file():
        return None
    kept = read_calibration(file, hand.motors, hand.limits, "fw")
    return kept.zero_rad


def kept_calibration(hand: HandFiles, file: Path, driver: str) -> Calibration | None:
    """What was measured before, where it still fits."""
    try:
        return read_calibration(file, hand.motors, hand.limits, driver)
    except CalibrationError:
        return None


def calibration_of(design: Path, hand: HandFiles, driver: str, port: str | None) -> Path:
    """File of the hand's calibration; simulated motors have one of their own, in the build."""
    if driver == "sim" or (port or "").partition(":")[0] in SIMULATED_PORTS:
        return hand.folder / "runs" / "calibration-sim.yaml"
    return calibration_file(design, hand.spec.name)


def enter_pressed(question: str) -> Callable[[], bool]:
    """Ask once; true when somebody has pressed Enter, without waiting for it."""
    asked = False

    def pressed() -> bool:
        nonlocal asked
        if not asked:
            console.print(question)
            asked = True
        ready, _, _ = select.select([sys.stdin], [], [], 0)
        if ready:
            sys.stdin.readline()
        return bool(ready)

    return pressed
