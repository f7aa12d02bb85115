"""Where a file comes from: the hand's name, the candidate and the spec's hash, put into every file."""

from __future__ import annotations

import csv
import io
import json
import re
import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from PIL import Image
from PIL.PngImagePlugin import PngInfo

from fpcad.errors import MakeError
from fpcad.store import write_whole

ABOUT = "about"
"""Key of the stamp in JSON and glTF files."""
STL_HEADER = 80
XML_DECLARATION = re.compile(rb"<\?xml [^>]*\?>\n")
GLB_HEADER = struct.Struct("<4sIIII")
"""Magic, version, length of the file; length and type of its first chunk, which is JSON."""
CARRIED = (".3mf", ".md")
"""Files whose writers put the stamp inside."""
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

    def write(self, file: Path, content: bytes | str) -> Path:
        """Write a file with the stamp in it, as a whole or not at all; its suffix tells the format."""
        return write_whole(file, self.on(file.suffix, content))

    def on(self, suffix: str, content: bytes | str) -> bytes:
        """The content of a file with the stamp in it; raises :class:`MakeError` for an unknown format."""
        raw = content.encode("utf-8") if isinstance(content, str) else content
        if suffix in CARRIED:
            return raw
        if suffix not in FORMATS:
            raise MakeError(f"no way to stamp a {suffix} file; known are {', '.join(FORMATS)}")
        return FORMATS[suffix](self, raw)

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

    def on_xml(self, content: bytes) -> bytes:
        """An XML document with the stamp as a comment before its root."""
        declaration = XML_DECLARATION.match(content)
        if declaration is None:
            raise MakeError("an XML file does not begin with its declaration")
        end, comment = declaration.end(), f"<!-- {self.text} -->\n".encode()
        return content[:end] + comment + content[end:]

    def on_lines(self, content: bytes) -> bytes:
        """A text with the stamp as its first line, a comment behind a `#`."""
        return f"# {self.text}\n".encode() + content

    def on_json(self, content: bytes) -> bytes:
        """A JSON object with the stamp as its first key."""
        if not content.startswith(b"{"):
            raise MakeError("a JSON file is stamped when it is an object")
        comma = b"" if content[1:].lstrip().startswith(b"}") else b","
        return f'{{"{ABOUT}": {json.dumps(self.text)}'.encode() + comma + content[1:]

    def on_csv(self, content: bytes) -> bytes:
        """A table with two more columns: hand and spec."""
        rows = list(csv.reader(io.StringIO(content.decode("utf-8"))))
        stream = io.StringIO()
        writer = csv.writer(stream, lineterminator="\n")
        for number, row in enumerate(rows):
            told = (self.hand, self.spec_sha256) if number else ("hand", "spec_sha256")
            writer.writerow([*row, *told])
        return stream.getvalue().encode()

    def on_glb(self, content: bytes) -> bytes:
        """A binary glTF with the stamp among the extras of its asset."""
        magic, version, _, length, kind = GLB_HEADER.unpack_from(content)
        start, end = GLB_HEADER.size, GLB_HEADER.size + length
        document = json.loads(content[start:end])
        document["asset"].setdefault("extras", {})[ABOUT] = self.text
        told = json.dumps(document, separators=(",", ":")).encode()
        told += b" " * (-len(told) % 4)
        whole = GLB_HEADER.size + len(told) + len(content) - end
        return GLB_HEADER.pack(magic, version, whole, len(told), kind) + told + content[end:]


FORMATS: Mapping[str, Callable[[Stamp, bytes], bytes]] = MappingProxyType(
    {
        **dict.fromkeys((".urdf", ".xml", ".srdf", ".xacro"), Stamp.on_xml),
        **dict.fromkeys((".yaml", ".py", ".txt", ".rviz"), Stamp.on_lines),
        ".stl": Stamp.on_stl,
        ".step": Stamp.on_step,
        ".png": Stamp.on_png,
        ".json": Stamp.on_json,
        ".csv": Stamp.on_csv,
        ".glb": Stamp.on_glb,
    }
)
"""How a file carries the stamp, by its suffix."""
