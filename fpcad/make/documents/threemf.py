"""3MF files: millimetres, materials with names and colours, and bytes that depend on the parts alone."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import lib3mf
import numpy as np
import trimesh
from lib3mf import get_wrapper

from fpcad.make.documents.stamp import Stamp

COLOURS = {"endoskeleton": (235, 232, 222), "skin": (224, 115, 77)}
NAMESPACE = uuid.UUID("6f1a3a52-52a4-5e0a-9b61-8a6f2f0c7d11")
"""Of the names from which the identifiers in a file are made; without them they would be random."""


@dataclass(frozen=True)
class Item:
    """One object on the bed."""

    name: str
    material: str
    """`endoskeleton` or `skin`."""
    material_name: str
    mesh: trimesh.Trimesh
    """[mm], as it lies on the bed."""


def threemf_bytes(items: Sequence[Item], stamp: Stamp) -> bytes:
    """A 3MF of all items; equal items give equal bytes."""
    model: Any = get_wrapper().CreateModel()
    model.SetUnit(lib3mf.ModelUnit.MilliMeter)
    about = model.GetMetaDataGroup()
    about.AddMetaData("", "Title", ", ".join(item.name for item in items), "xs:string", True)
    about.AddMetaData("", "Description", stamp.text, "xs:string", True)
    group = model.AddBaseMaterialGroup()
    known: dict[str, int] = {}
    for item in items:
        if item.material not in known:
            colour = lib3mf.Color(*COLOURS[item.material], 255)
            known[item.material] = group.AddMaterial(item.material_name, colour)
        body = _object(model, item)
        body.SetObjectLevelProperty(group.GetResourceID(), known[item.material])
        placed = model.AddBuildItem(body, get_wrapper().GetIdentityTransform())
        placed.SetUUID(_uuid(stamp, "item", item.name))
        body.SetUUID(_uuid(stamp, "object", item.name))
    model.SetBuildUUID(_uuid(stamp, "build", *(item.name for item in items)))
    return bytes(model.QueryWriter("3mf").WriteToBuffer())


def _object(model: Any, item: Item) -> Any:
    body = model.AddMeshObject()
    body.SetName(item.name)
    vertices = np.asarray(item.mesh.vertices, dtype=float).tolist()
    faces = np.asarray(item.mesh.faces, dtype=int).tolist()
    body.SetGeometry(
        [lib3mf.Position(tuple(vertex)) for vertex in vertices],
        [lib3mf.Triangle(tuple(face)) for face in faces],
    )
    return body


def _uuid(stamp: Stamp, *names: str) -> str:
    return str(uuid.uuid5(NAMESPACE, "/".join((stamp.text, *names))))
