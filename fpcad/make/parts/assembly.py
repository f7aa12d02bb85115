"""All that a hand is put together from: printed parts, and bought items where they sit."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import trimesh

from fpcad.make.mesh import mesh_of
from fpcad.make.parts.bone import distal_bone, proximal_bone
from fpcad.make.parts.dimensions import Dimensions, finger_dimensions
from fpcad.make.parts.mcp import mcp_cross
from fpcad.make.parts.palm import palm_solid
from fpcad.make.parts.part import Array, Material, Part, Placement, placements
from fpcad.make.parts.skin import distal_skin, proximal_skin
from fpcad.make.parts.solids import Solid
from fpcad.model.geometry import HandGeometry
from fpcad.spec.schema import Spec

Progress = Callable[[str], None]
"""Told what is being made, in a few words."""


@dataclass(frozen=True)
class BoughtItem:
    """One kind of bought item on one link: bearing, pin, screw, insert, motor, tube."""

    name: str
    """What it does, such as `ip_bearing`."""
    kind: str
    """Table of the catalogue: `bearings`, `pins`, `screws`, `inserts`, `motors`, `tubes`."""
    size: str
    """Row of that table, such as `MR63`."""
    link: str
    """`palm`, or the link of every finger that carries it."""
    places: tuple[Array, ...]
    """T_link_item (4, 4) [mm] of each copy on one link; the item's axis is z of its own frame."""
    count: int
    """How many of it a hand needs."""
    mass_g: float
    """Of one piece."""
    mesh: trimesh.Trimesh
    """[mm] in the item's frame: its envelope, for interference checks and pictures."""
    length_mm: float | None = None
    """Length of a pin, screw or tube that comes in lengths."""

    def placements(self, fingers: Iterable[str]) -> list[Placement]:
        """Where each copy in the hand sits."""
        return placements(self.link, self.places, fingers)


@dataclass(frozen=True)
class Assembly:
    """A whole hand at zero joint angles; URDF link frames place it at any other."""

    parts: tuple[Part, ...]
    bought: tuple[BoughtItem, ...]


def make_assembly(spec: Spec, geometry: HandGeometry, progress: Progress) -> Assembly:
    """Everything of a hand; raises :class:`fpcad.errors.MakeError` with the reason otherwise."""
    return Assembly(tuple(make_parts(spec, geometry, progress)), ())


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
