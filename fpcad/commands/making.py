"""Verbs about what is printed: check a hand's files, slice them."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from fpcad.commands.options import AsJson, BuildFolder, Design, run_folder
from fpcad.commands.summary import out

verbs = typer.Typer()

Thorough = Annotated[
    bool,
    typer.Option(
        "--thorough", help="Walk whole planes of joint angles, some minutes, instead of lines."
    ),
]


@verbs.command()
def check(
    name: Design,
    build: BuildFolder = Path("build"),
    thorough: Thorough = False,
    as_json: AsJson = False,
) -> None:
    """Run all gates again on the files of a finished hand. Exit code 0, or 6 where one fails."""
    from fpcad.errors import MakeError
    from fpcad.make.documents.recheck import recheck
    from fpcad.make.gates.finding import Finding, errors
    from fpcad.make.gates.reach import SOME
    from fpcad.pipeline.finished import finished_hand

    spec, geometry = finished_hand(folder := run_folder(name, build))
    findings: list[Finding] = []
    for title, found in recheck(spec, geometry, folder, 1 if thorough else SOME):
        findings += found
        if not as_json:
            _print_group(title, found)
    if as_json:
        typer.echo(json.dumps([asdict(finding) for finding in findings], indent=2))
    faults = errors(findings)
    if faults:
        raise typer.Exit(MakeError.exit_code)


@verbs.command("slice")
def slice_parts(
    name: Design,
    build: BuildFolder = Path("build"),
    layer_mm: Annotated[
        float, typer.Option(min=0.05, max=0.6, help="Height of a layer [mm].")
    ] = 0.2,
) -> None:
    """Slice every printed part with PrusaSlicer, and put the hours into bom.csv."""
    from fpcad.make.bom import write_hours
    from fpcad.make.documents.slicing import slice_folder
    from fpcad.pipeline.finished import finished_hand

    folder = run_folder(name, build)
    spec, _ = finished_hand(folder)
    hours = {}
    for sliced in slice_folder(folder / "parts", spec.print, layer_mm):
        hours[sliced.part] = sliced.hours
        out.print(f"{sliced.part}: {sliced.hours:.2f} h, {sliced.filament_g:.1f} g, {sliced.file}")
    write_hours(folder / "parts" / "bom.csv", hours)


def _print_group(title: str, found: list) -> None:
    from rich.markup import escape

    from fpcad.make.gates.finding import Severity

    colours = {Severity.ERROR: "red", Severity.WARNING: "yellow", Severity.FIGURE: "green"}
    out.print(f"[bold]{escape(title)}[/bold]", highlight=False)
    for finding in found:
        colour = colours[finding.severity]
        told = f"  [{colour}]{finding.severity.value:7}[/{colour}] {escape(str(finding))}"
        out.print(told, highlight=False, soft_wrap=True)
    if not found:
        out.print("  nothing found", style="green")
