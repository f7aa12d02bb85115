"""parts/assembly.json: what a hand is put together from and where each copy sits, as files."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

from fpcad.errors import StoreError
from fpcad.make.documents.stamp import Stamp
from fpcad.make.documents.step_files import read_step
from fpcad.make.mesh import stl_bytes
from fpcad.make.parts.assembly import Assembly, BoughtItem
from fpcad.make.parts.part import Part
from fpcad.store import read_json

FILE, BOUGHT = "assembly.json", "bought"


def write_inventory(assembly: Assembly, folder: Path, stamp: Stamp) -> list[Path]:
    """Write the list, and the envelopes of what is bought, into a build's `parts` folder."""
    files = [
        stamp.write(folder / BOUGHT / f"{item.name}.stl", stl_bytes(item.mesh))
        for item in assembly.bought
    ]
    document = {
        "unit": "mm",
        "parts": [_part(part) for part in assembly.parts],
        "bought": [_bought(item) for item in assembly.bought],
    }
    text = json.dumps(document, indent=1, allow_nan=False) + "\n"
    return [*files, stamp.write(folder / FILE, text)]


def read_inventory(folder: Path) -> Assembly:
    """The assembly as the files of a `parts` folder tell it; the meshes are those of the STL files."""
    document = read_json(folder / FILE)
    try:
        return Assembly(
            tuple(_read_part(row, folder) for row in document["parts"]),
            tuple(_read_bought(row, folder) for row in document["bought"]),
        )
    except (KeyError, TypeError, ValueError) as error:
        raise StoreError(f"{folder / FILE}: not as fpcad writes it ({error!r})") from error


def _part(part: Part) -> dict[str, Any]:
    return {
        "name": part.name,
        "link": part.link,
        "material": part.material,
        "count": part.count,
        "mesh": f"{part.material}/{part.name}.stl",
        "solid": f"step/{part.name}.step",
        "T_link_part": [T.tolist() for T in part.places],
        "T_bed_part": part.T_bed_part.tolist(),
    }


def _bought(item: BoughtItem) -> dict[str, Any]:
    return {
        **{key: getattr(item, key) for key in ("name", "kind", "size", "link", "count", "mass_g")},
        "length_mm": item.length_mm,
        "mesh": f"{BOUGHT}/{item.name}.stl",
        "T_link_item": [T.tolist() for T in item.places],
    }


def _read_part(row: Mapping[str, Any], folder: Path) -> Part:
    return Part(
        name=row["name"],
        link=row["link"],
        material=row["material"],
        count=int(row["count"]),
        solid=read_step(folder / row["solid"]),
        mesh=read_mesh(folder / row["mesh"]),
        places=tuple(np.array(T, dtype=float) for T in row["T_link_part"]),
        T_bed_part=np.array(row["T_bed_part"], dtype=float),
    )


def _read_bought(row: Mapping[str, Any], folder: Path) -> BoughtItem:
    same = {key: row[key] for key in ("name", "kind", "size", "link", "count", "mass_g")}
    places = tuple(np.array(T, dtype=float) for T in row["T_link_item"])
    return BoughtItem(
        **same, length_mm=row["length_mm"], places=places, mesh=read_mesh(folder / row["mesh"])
    )


def read_mesh(file: Path) -> trimesh.Trimesh:
    """The triangles of an STL file, corners joined, without those that its single floats flattened."""
    try:
        mesh = trimesh.load_mesh(file)
    except (OSError, ValueError) as error:
        raise StoreError(f"{file}: not readable as STL ({error})") from error
    mesh.update_faces(mesh.nondegenerate_faces())
    mesh.remove_unreferenced_vertices()
    return mesh
