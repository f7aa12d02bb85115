"""STEP files: each part alone, and the whole hand put together."""

from __future__ import annotations

import re
import tempfile
from itertools import count
from pathlib import Path

import numpy as np

from fpcad.errors import MakeError, StoreError
from fpcad.make.gates.bodies import link_poses
from fpcad.make.parts.assembly import Assembly
from fpcad.make.parts.part import STILL_LINKS
from fpcad.make.parts.solids import Solid
from fpcad.make.parts.step import step_bytes
from fpcad.make.toolchain import cadquery
from fpcad.model.geometry import HandGeometry

_TIMESTAMP = re.compile(rb"'\d{4}-\d{2}-\d{2}T\d{2}:\d{2}:\d{2}'")
_PRODUCT = re.compile(rb"'Open CASCADE STEP translator [^']*'")
_OCCURRENCE = re.compile(rb"NEXT_ASSEMBLY_USAGE_OCCURRENCE\('\d+',(.*?)\);", re.DOTALL)
_NEGATIVE_ZERO = re.compile(rb"(?<=[(,])-0\.(?=[,)])")
_TINY = re.compile(rb"(?<=[(,])-?\d\.\d*E-1[3-9]\b")
"""Coordinates [mm] that are zero but for the kernel's last bits, which differ from run to run."""


def part_step(name: str, solid: Solid) -> bytes:
    """One part as STEP [mm] in its own frame."""
    return _steady(step_bytes(name, solid))


def _steady(step: bytes) -> bytes:
    return _NEGATIVE_ZERO.sub(b"0.", _TINY.sub(b"0.", step))


def assembly_step(assembly: Assembly, geometry: HandGeometry, title: str) -> bytes:
    """All printed parts of the straight hand as STEP [mm] in H, with their names.

    Without colours: the kernel writes those in another order each time.
    """
    cq = cadquery()
    whole = cq.Assembly(name=title)
    straight = np.zeros((1, 3))
    for part in assembly.parts:
        fingers = (None,) if part.link in STILL_LINKS else geometry.fingers
        for finger in fingers:
            pose = np.eye(4)
            if finger is not None:
                pose = link_poses(geometry, finger, part.link, straight)[0]
            for number, place in enumerate(part.places, start=1):
                copy = str(number) if len(part.places) > 1 else ""
                name = "_".join(word for word in (finger, part.name, copy) if word)
                whole.add(part.solid, name=name, loc=_location(pose @ place))
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "assembly.step"
        whole.export(str(file), "STEP")
        if not file.is_file():
            raise MakeError("the modelling kernel wrote no STEP file of the assembly")
        text = file.read_bytes()
    text = _TIMESTAMP.sub(b"'1970-01-01T00:00:00'", text)
    text = _PRODUCT.sub(b"'" + title.encode() + b"'", text)
    return _steady(_numbered(text))


def _numbered(step: bytes) -> bytes:
    """Occurrences numbered within the file; the kernel counts on from the files before."""
    numbers = count(1)

    def one_line(match: re.Match[bytes]) -> bytes:
        told = b"".join(line.strip() for line in match.group(1).splitlines())
        return b"NEXT_ASSEMBLY_USAGE_OCCURRENCE('%d',%s);" % (next(numbers), told)

    return _OCCURRENCE.sub(one_line, step)


def read_step(file: Path) -> Solid:
    """The solid of a STEP file."""
    if not file.is_file():
        raise StoreError(f"{file} is missing; run `fpcad export` again")
    try:
        return cadquery().importers.importStep(str(file)).val()
    except ValueError as error:
        raise StoreError(f"{file}: not readable as STEP ({error})") from error


def _location(pose: np.ndarray) -> object:
    cq = cadquery()
    x_axis, z_axis, origin = (tuple(map(float, pose[:3, column])) for column in (0, 2, 3))
    return cq.Location(cq.Plane(origin, x_axis, z_axis))
