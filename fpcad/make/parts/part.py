"""A printed part: its solid, its mesh, and where each copy sits in the hand."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
import trimesh
from numpy.typing import NDArray

from fpcad.make.parts.solids import Solid

Array = NDArray[np.float64]

Material = Literal["endoskeleton", "skin", "metal"]
"""Printed rigid, printed flexible, or made to order."""

FIXED_LINK = "palm"
"""The one link that is no finger's: palm, flange and motor box are all fixed to it."""
BOX_LINK = "box"
"""No link of the robot: what belongs to a motor box that stands elsewhere, in the palm's frame."""
STILL_LINKS = (FIXED_LINK, BOX_LINK)


def in_place() -> tuple[Array, ...]:
    """One copy, modelled where it sits."""
    return (np.eye(4),)


@dataclass(frozen=True)
class Placement:
    """Where one copy of a part or bought item sits."""

    link: str
    """Link of the URDF: `palm` or `<finger>_<link>`."""
    T_link_item: Array  # (4, 4) [mm]


def placements(link: str, places: Iterable[Array], fingers: Iterable[str]) -> list[Placement]:
    """Every copy of what sits at `places` on the palm, or on the same link of each finger."""
    names = [link] if link in STILL_LINKS else [f"{finger}_{link}" for finger in fingers]
    return [Placement(name, T) for name in names for T in places]


@dataclass(frozen=True)
class Part:
    """One printed part. It is modelled in the frame of its first copy's place."""

    name: str
    link: str
    """`palm`, or the link of every finger that carries copies: `mcp`, `proximal`, `distal`."""
    material: Material
    count: int
    """How many of it a hand needs."""
    solid: Solid
    mesh: trimesh.Trimesh
    """[mm], watertight, one body."""
    places: tuple[Array, ...] = field(default_factory=in_place)
    """T_link_part (4, 4) [mm] of each copy on one link. What turns on its own about the flexion axis
    (pulleys, drum) is round, and counts to the link `mcp`."""
    T_bed_part: Array = field(default_factory=lambda: np.eye(4))
    """(4, 4) rotation to the proposed print orientation, z up; drop it to z = 0 before slicing."""

    @property
    def on_link(self) -> trimesh.Trimesh:
        """Mesh [mm] of all copies on one link, in the link's frame."""
        copies = [self.mesh.copy().apply_transform(T) for T in self.places]
        whole = trimesh.util.concatenate(copies)
        if not isinstance(whole, trimesh.Trimesh):
            raise TypeError(f"{self.name}: copies make up a {type(whole).__name__}, not one mesh")
        return whole

    def placements(self, fingers: Iterable[str]) -> list[Placement]:
        """Where each copy in the hand sits."""
        return placements(self.link, self.places, fingers)
