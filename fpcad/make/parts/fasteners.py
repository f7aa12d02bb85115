"""Screws and heat-set inserts as bought items, each with its axis along z of its own frame."""

from __future__ import annotations

import math

import numpy as np
import trimesh

from fpcad.make.parts.bought import SECTIONS, BoughtItem
from fpcad.make.parts.catalogue import Insert, Screw
from fpcad.make.parts.part import Array

BRASS_G_MM3 = 8.5e-3


def screw_item(
    name: str, screw: Screw, length: float, link: str, places: tuple[Array, ...]
) -> BoughtItem:
    """Socket head screws of a length [mm]: z = 0 lies under the head, the shank points to -z."""
    outline = [
        (0.0, -length),
        (screw.thread_mm / 2, -length),
        (screw.thread_mm / 2, 0.0),
        (screw.head_diameter_mm / 2, 0.0),
        (screw.head_diameter_mm / 2, screw.head_height_mm),
        (0.0, screw.head_height_mm),
    ]
    mesh = trimesh.creation.revolve(np.array(outline), sections=SECTIONS)
    mass = screw.mass_g(length)
    return BoughtItem(
        name, "screws", screw.size, link, places, len(places), mass, mesh, length_mm=length
    )


def insert_item(name: str, insert: Insert, link: str, places: tuple[Array, ...]) -> BoughtItem:
    """Heat-set inserts: z = 0 is the mouth, flush with the part, the rest points to -z."""
    mesh = trimesh.creation.cylinder(insert.outer_mm / 2, insert.length_mm, sections=SECTIONS)
    mesh.apply_translation((0.0, 0.0, -insert.length_mm / 2))
    ring = math.pi / 4 * (insert.outer_mm**2 - insert.thread_mm**2)
    mass = ring * insert.length_mm * BRASS_G_MM3
    return BoughtItem(name, "inserts", insert.size, link, places, len(places), mass, mesh)
