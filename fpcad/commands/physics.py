"""The verb that tries a built hand in physics."""

from __future__ import annotations

import json
import time
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.table import Table

from fpcad.commands.console import console
from fpcad.commands.drive import trajectory_file
from fpcad.commands.options import AsJson, BuildFolder, Design, spec_file
from fpcad.spec import load_spec

if TYPE_CHECKING:
    from fpcad.simulate.hold import Hold
    from fpcad.simulate.trials import Tried

verbs = typer.Typer()


@verbs.command()
def simulate(
    name: Design,
    pose: Annotated[str, typer.Option(help="Pose whose trajectory is run.")],
    build: BuildFolder = Path("build"),
    hold: Annotated[
        bool, typer.Option("--hold", help="Hold the tool still instead, gravity along each axis.")
    ] = False,
    friction: Annotated[
        float | None, typer.Option(min=0.0, help="Coefficient of friction; the spec's by default.")
    ] = None,
    step: Annotated[
        float, typer.Option(min=0.05, max=1.0, help="Step of the simulation [ms].")
    ] = 0.5,
    with_film: Annotated[bool, typer.Option("--film/--no-film", help="Write a GIF.")] = True,
    as_json: AsJson = False,
) -> None:
    """Try a built hand in MuJoCo: does its trajectory, run in the open loop, turn the tool?

    Writes simulation/POSE.json, curves and a film to the build folder.
    """
    from fpcad.simulate.pose import hold_pose, report_of, simulate_pose, write_pose

    spec = load_spec(spec_file(name))
    folder = build / spec.name
    trajectory_file(folder, pose)
    with console.status(pose) as status:
        if hold:
            _print_holds(hold_pose(spec, folder, pose, status.update), as_json)
            return
        began = time.perf_counter()
        tried = simulate_pose(spec, folder, pose, friction, step / 1000.0, status.update)
        took = time.perf_counter() - began
        status.update("pictures")
        files = write_pose(spec, folder, pose, tried, with_film)
    if as_json:
        typer.echo(json.dumps(report_of(tried), indent=2))
        return
    _print_trials(tried)
    speed = sum(one.record.seconds for one in tried) / took
    console.print(f"{speed:.1f} times real time; {', '.join(map(str, files))}", highlight=False)


def _print_trials(tried: list[Tried]) -> None:
    table = Table("trial", "held", "turned, planned [deg]", "tilt [deg]", "slip [mm]", "at limit")
    for one in tried:
        told = one.outcome
        tipped = "" if told.tipped_at_s is None else f"tips at {told.tipped_at_s:.1f} s"
        lost = "" if told.held else f"lost at {told.lost_at_s:.1f} s"
        held = ", ".join(filter(None, (tipped, lost))) or "yes"
        slip = ", ".join(f"{way:.0f}" for way in told.slip_mm)
        turned = f"{told.reached_deg:.0f}, {told.planned_deg:.0f}"
        tilt, limit = f"{told.worst_tilt_deg:.0f}", f"{told.saturated_share:.0%}"
        table.add_row(one.name, held, turned, tilt, slip, limit)
    console.print(table)


def _print_holds(found: list[Hold], as_json: bool) -> None:
    if as_json:
        typer.echo(json.dumps([asdict(hold) for hold in found], indent=2))
        return
    table = Table("gravity", "tool [g]", "preload", "sag [mm, deg]", "drift [mm, deg]", "still")
    for hold in found:
        sag, drift = (
            f"{hold.sag_mm:.2f}, {hold.sag_deg:.2f}",
            f"{hold.drift_mm:.2f}, {hold.drift_deg:.2f}",
        )
        mass, preload = f"{1000 * hold.tool_mass_kg:.0f}", f"{hold.preload:.0%}"
        table.add_row(hold.gravity, mass, preload, sag, drift, "yes" if hold.still else "no")
    console.print(table)
