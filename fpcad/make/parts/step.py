"""STEP files whose bytes depend on the solid alone."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path

from fpcad.errors import MakeError
from fpcad.make.parts.solids import Solid

_TIMESTAMP = re.compile(rb"'\d{4}-\d{2}-\d{2}T\d{2}:\d{2}:\d{2}'")
_PRODUCT = re.compile(rb"'Open CASCADE STEP translator [^']*'")


def step_bytes(name: str, solid: Solid) -> bytes:
    """A solid as STEP [mm]; the kernel's clock and its running count of files are taken out."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{name}.step"
        solid.exportStep(str(path))
        if not path.is_file():
            raise MakeError(f"part {name}: the modelling kernel wrote no STEP file")
        text = path.read_bytes()
    text, stamps = _TIMESTAMP.subn(b"'1970-01-01T00:00:00'", text, count=1)
    text, products = _PRODUCT.subn(b"'" + name.encode() + b"'", text)
    if stamps != 1 or products == 0:
        raise MakeError(f"part {name}: the header of its STEP file is not as expected")
    return text
