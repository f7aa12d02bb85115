"""Where a file comes from: the hand's name, the candidate and the spec's hash, put into every file."""

from __future__ import annotations

import io
from dataclasses import dataclass

from PIL import Image
from PIL.PngImagePlugin import PngInfo

from fpcad.errors import MakeError

STL_HEADER = 80
STEP_DESCRIPTION = b"FILE_DESCRIPTION(('Open CASCADE Model')"


@dataclass(frozen=True)
class Stamp:
    """Name of the design, id of the candidate and SHA-256 of the spec."""

    name: str
    candidate: int | None
    """None for a hand that was not sampled."""
    spec_sha256: str

    @property
    def hand(self) -> str:
        """The candidate's id, or nothing."""
        return "" if self.candidate is None else str(self.candidate)

    @property
    def text(self) -> str:
        """One line, short enough for the header of an STL file."""
        return f"fpcad {self.name:.24s} hand {self.hand or '-'} spec {self.spec_sha256[:16]}"

    def on_stl(self, content: bytes) -> bytes:
        """A binary STL with the stamp in its header."""
        return (
            self.text.encode("ascii").ljust(STL_HEADER, b"\0")[:STL_HEADER] + content[STL_HEADER:]
        )

    def on_step(self, content: bytes) -> bytes:
        """A STEP file with the stamp as its description."""
        if STEP_DESCRIPTION not in content:
            raise MakeError("a STEP file's header is not as expected")
        stamped = f"FILE_DESCRIPTION(('{self.text}')".encode()
        return content.replace(STEP_DESCRIPTION, stamped, 1)

    def on_png(self, content: bytes) -> bytes:
        """A PNG with the stamp as its comment."""
        told = PngInfo()
        told.add_text("Comment", self.text)
        stream = io.BytesIO()
        Image.open(io.BytesIO(content)).save(stream, "PNG", pnginfo=told, optimize=True)
        return stream.getvalue()
