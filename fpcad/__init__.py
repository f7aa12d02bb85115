"""fpcad: from one YAML file to a tool-wielding robotic hand on the wire.

The command line is `fpcad`; from Python, :func:`load_spec` reads a design,
`fpcad.pipeline.run_stages` makes it and :func:`load` opens what was made.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from fpcad.errors import FpcadError, SpecError
from fpcad.spec import Spec, load_spec

if TYPE_CHECKING:
    from fpcad.look.run import Run

__all__ = ["FpcadError", "Spec", "SpecError", "load", "load_spec"]


def load(folder: Path | str) -> Run:
    """The run in a build folder: `fpcad.load("build/clay").table`. Docs: docs/report.md."""
    from fpcad.look.run import load as load_run  # tables and model are slow to import

    return load_run(folder)
