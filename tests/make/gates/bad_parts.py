"""Parts that no gate may let pass."""

from __future__ import annotations

import numpy as np
import trimesh

from fpcad.make.parts.part import Part
from fpcad.make.parts.solids import ball, box


def part(name: str, mesh: trimesh.Trimesh, solid: object = None, link: str = "palm") -> Part:
    """A part around a mesh; its solid is a sound one unless another is given."""
    sound = ball((0, 0, 0), 1.0) if solid is None else solid
    return Part(name, link, "endoskeleton", 1, sound, mesh)


def block() -> trimesh.Trimesh:
    """A sound block of 20 x 20 x 10 mm."""
    return trimesh.creation.box((20, 20, 10))


def with_thin_wall(wall_mm: float) -> trimesh.Trimesh:
    """A block with a deep pocket, whose floor at z = 5 is thin."""
    pocket = trimesh.creation.box((14, 14, 10))
    pocket.apply_translation((0, 0, -wall_mm))
    return trimesh.boolean.difference([block(), pocket], engine="manifold")


def with_open_mesh() -> trimesh.Trimesh:
    """A block that lacks one triangle."""
    mesh = block()
    mesh.update_faces(np.arange(len(mesh.faces)) > 0)
    return mesh


def of_two_bodies() -> trimesh.Trimesh:
    """A block and a crumb."""
    crumb = trimesh.creation.box((2, 2, 2))
    crumb.apply_translation((30, 0, 0))
    return trimesh.util.concatenate(block(), crumb)  # type: ignore[return-value]


def two_solids() -> object:
    """What the modelling kernel calls one shape and is two."""
    return box((0, 0, 0), (1, 1, 1)).fuse(box((5, 0, 0), (6, 1, 1)))
