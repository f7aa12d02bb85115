"""Arguments and options that several verbs share, and the files that they name."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

DESIGNS = Path("designs")

Design = Annotated[
    str, typer.Argument(metavar="NAME", help="A design: `clay` for designs/clay.yaml, or a file.")
]
BuildFolder = Annotated[
    Path, typer.Option("--build", metavar="DIR", help="Folder for everything that is made.")
]
WorkerCount = Annotated[
    int,
    typer.Option("--workers", "-j", min=0, help="Processes side by side; 0: one for each core."),
]
Force = Annotated[bool, typer.Option("--force", help="Make the last stage again.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print the result as JSON on stdout.")]


def spec_file(name: str) -> Path:
    """File of a design that is given by name or by path."""
    named = DESIGNS / f"{name}.yaml"
    is_path = name.endswith((".yaml", ".yml")) or "/" in name
    return Path(name) if is_path else named


def run_folder(name: str, build: Path) -> Path:
    """Build folder of a design that is given by name, by spec file, or itself."""
    return Path(name) if (Path(name) / "manifest.json").is_file() else build / Path(name).stem
