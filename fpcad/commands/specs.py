"""Verbs about specs: begin one, check one, tell what is allowed in one."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Annotated

import typer

from fpcad.commands.options import DESIGNS, AsJson, spec_file
from fpcad.errors import SpecError
from fpcad.spec import find_faults, json_schema, write_new

verbs = typer.Typer()


@verbs.command()
def new(name: Annotated[str, typer.Argument(help="Name of the new design.")]) -> None:
    """Write designs/NAME.yaml, a commented spec to start from."""
    typer.echo(f"{write_new(name, DESIGNS)}: edit it, then run `fpcad design {name}`")


@verbs.command()
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


@verbs.command()
def schema() -> None:
    """Print the JSON schema of specs, for editors."""
    typer.echo(json.dumps(json_schema(), indent=2))
