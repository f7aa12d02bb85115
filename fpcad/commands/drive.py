"""From a build folder to a run: which files belong together, and a bar while it lasts."""

from __future__ import annotations

import math
from pathlib import Path

from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from fpcad.commands.console import console
from fpcad.errors import StoreError
from fpcad.run import report as runs
from fpcad.run.limits import JointLimits, read_limits
from fpcad.run.run_trajectory import DryRun, dry_run, run_trajectory
from fpcad.spec import Spec
from fpcad.units import RAD_PER_DEG


def drive(
    spec: Spec,
    folder: Path,
    pose: str,
    port: str,
    speed: float,
    loops: int,
    move_to_start: bool,
    clear: bool,
    check_only: bool,
    log: Path | None,
) -> runs.RunReport | DryRun:
    """Run one pose's trajectory of the hand in a build folder, or only check it."""
    trajectory, limits = trajectory_file(folder, pose), hand_limits(spec, folder)
    if check_only:
        return dry_run(trajectory, limits, speed=speed, loops=loops)
    columns = [
        TextColumn("{task.description:<10}"),
        BarColumn(32),
        TextColumn("{task.completed:.1f}/{task.total:.1f} s"),
        TimeRemainingColumn(),
        TextColumn("[dim]{task.fields[note]}"),
    ]
    with Progress(*columns, console=console) as progress:
        task = progress.add_task(pose, total=1.0, note="connecting")

        def show(at: runs.Progress) -> None:
            note = f"{at.state}, error {math.degrees(at.error_rad):.2f} deg, {at.resends} resends"
            progress.update(task, completed=at.path_s, total=at.total_s, note=note)

        return run_trajectory(
            trajectory,
            limits,
            port,
            speed=speed,
            loops=loops,
            move_to_start=move_to_start,
            clear=clear,
            log=log,
            on_progress=show,
        )


def trajectory_file(folder: Path, pose: str) -> Path:
    """The trajectory of a pose; :class:`StoreError` tells which ones there are."""
    file = folder / "trajectories" / f"{pose}.json"
    if not file.is_file():
        there = ", ".join(sorted(f.stem for f in file.parent.glob("*.json")))
        advice = f"there are: {there}" if there else f"make them with `fpcad design {folder.name}`"
        raise StoreError(f"{folder}: no trajectory of a pose `{pose}`; {advice}")
    return file


def hand_limits(spec: Spec, folder: Path) -> JointLimits:
    """Limits of the built hand: the URDF's, and the spec's acceleration."""
    urdf = folder / "hand" / "urdf" / f"{spec.name}.urdf"
    acceleration = spec.motion.joint_acceleration_deg_s2 * RAD_PER_DEG
    return read_limits(urdf, acceleration, folder / "hand" / "transmission.yaml")
