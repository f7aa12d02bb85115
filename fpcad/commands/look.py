"""Verbs that show what a run has made."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fpcad.commands.options import BuildFolder, Design, WorkerCount, run_folder

verbs = typer.Typer()


@verbs.command()
def report(name: Design, build: BuildFolder = Path("build")) -> None:
    """Write report.html, one page to look at a run with, finished or not."""
    from fpcad.look.report import write_report

    typer.echo(write_report(run_folder(name, build)))


@verbs.command()
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
    from fpcad.commands.explore import explore_run

    explore_run(run_folder(name, build), host, port, workers)


@verbs.command()
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


@verbs.command()
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
