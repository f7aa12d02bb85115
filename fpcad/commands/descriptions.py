"""Verbs about robot descriptions, ours or another's."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fpcad.commands.options import AsJson

if TYPE_CHECKING:
    from fpcad.check_description import Report

verbs = typer.Typer()

FAULTY = 7
"""Exit code where a check found a fault."""


@verbs.command("check-description")
def check_description(
    folder: Annotated[
        Path,
        typer.Argument(
            metavar="DIR",
            exists=True,
            file_okay=False,
            help="A package: build/NAME/hand, or any folder with URDF files.",
        ),
    ],
    as_json: AsJson = False,
) -> None:
    """Check a robot's description: tree, inertias, limits, meshes, and that its files agree.

    Exit code 7 tells that something is wrong.
    """
    from fpcad.check_description import check_description as checked

    report = checked(folder)
    if as_json:
        rows = [asdict(row) for row in report.rows]
        typer.echo(json.dumps({"good": report.is_good, "rows": rows}, indent=2))
    else:
        _print(report)
    if not report.is_good:
        raise typer.Exit(FAULTY)


def _print(report: Report) -> None:
    from rich.markup import escape
    from rich.table import Table

    from fpcad.commands.summary import out

    for robot in dict.fromkeys(row.robot for row in report.rows):
        table = Table("check", "verdict", "what", title=robot, title_justify="left")
        for row in (row for row in report.rows if row.robot == robot):
            lines = [f"{fault.subject}: {fault.message}" for fault in row.faults]
            colour = {"good": "green", "faulty": "red", "skipped": "dim"}[row.verdict]
            what = "\n".join(lines) or row.reason or row.rule
            table.add_row(row.check, f"[{colour}]{row.verdict}[/{colour}]", escape(what))
        out.print(table)
