"""The command line: the app, its options, and how errors end it. Its verbs are in `fpcad.commands`."""

from __future__ import annotations

import sys
from importlib.metadata import version
from typing import Annotated

import typer
from rich.markup import escape

from fpcad.commands import descriptions, look, making, motors, physics, specs, stages, wire
from fpcad.commands.console import console, start_logging
from fpcad.errors import FpcadError

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
for _room in (specs, stages, look, making, descriptions, wire, motors, physics):
    app.add_typer(_room.verbs)

INTERRUPTED = 130


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
