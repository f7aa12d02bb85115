"""A printed part and the list of them that makes a hand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import trimesh

from fpcad.make.mesh import mesh_of
from fpcad.make.parts.bone import distal_bone, proximal_bone
from fpcad.make.parts.dimensions import Dimensions, finger_dimensions
from fpcad.make.parts.mcp import mcp_cross
from fpcad.make.parts.palm import palm_solid
from fpcad.make.parts.skin import distal_skin, proximal_skin
from fpcad.make.parts.solids import Solid
from fpcad.model.geometry import HandGeometry
from fpcad.spec.schema import Spec

Material = Literal["endoskeleton", "skin"]


@dataclass(frozen=True)
class Part:
    """One printed part in the frame of the link that it belongs to."""

    name: str
    link: str
    """`palm`, or the link of every finger that carries a copy: `mcp`, `proximal`, `distal`."""
    material: Material
    count: int
    """How many of it a hand needs."""
    solid: Solid
    mesh: trimesh.Trimesh
    """[mm], watertight, one body."""


Progress = Callable[[str], None]
"""Told what is being made, in a few words."""


def make_parts(spec: Spec, geometry: HandGeometry, progress: Progress) -> list[Part]:
    """All printed parts of a hand; parts that fingers share are made once."""
    d, fingers = finger_dimensions(spec, geometry), len(geometry.fingers)
    makers: list[tuple[str, str, Material, int, Callable[[Dimensions], Solid]]] = [
        ("palm", "palm", "endoskeleton", 1, lambda d: palm_solid(geometry, d)),
        ("mcp_cross", "mcp", "endoskeleton", fingers, mcp_cross),
        ("proximal_bone", "proximal", "endoskeleton", fingers, proximal_bone),
        ("proximal_skin", "proximal", "skin", fingers, proximal_skin),
        ("distal_bone", "distal", "endoskeleton", fingers, distal_bone),
        ("distal_skin", "distal", "skin", fingers, distal_skin),
    ]
    parts = []
    for name, link, material, count, make in makers:
        progress(name)
        solid = make(d)
        parts.append(Part(name, link, material, count, solid, mesh_of(name, solid, spec.print)))
    return parts
