"""Parts as they lie on the printer's bed: parts/print/NAME.stl and NAME.3mf."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import trimesh

from fpcad.make.documents.stamp import Stamp
from fpcad.make.documents.threemf import Item, threemf_bytes
from fpcad.make.gates.orientation import part_orientation
from fpcad.make.mesh import stl_bytes
from fpcad.make.parts.materials import matters
from fpcad.make.parts.part import Part
from fpcad.spec.hardware import Print

FOLDER = "print"


def on_bed(part: Part, settings: Print) -> trimesh.Trimesh:
    """The part's mesh [mm] laid as proposed: on z = 0, around the origin."""
    return part.mesh.copy().apply_transform(part_orientation(part, settings).T_bed_part)


def write_print_files(
    parts: Sequence[Part], settings: Print, folder: Path, stamp: Stamp
) -> list[Path]:
    """Write each printed part, laid as it is to be printed, as STL and as 3MF."""
    files, named = [], matters(settings)
    for part in parts:
        if part.material == "metal":
            continue
        mesh = on_bed(part, settings)
        item = Item(part.name, part.material, named[part.material].name, mesh)
        place = folder / FOLDER / part.name
        files.append(stamp.write(place.with_suffix(".stl"), stl_bytes(mesh)))
        files.append(stamp.write(place.with_suffix(".3mf"), threemf_bytes([item], stamp)))
    return files
