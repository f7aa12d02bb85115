"""The bought items of a finger, each where it sits: axle, pins, bearings."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import trimesh

from fpcad.make.parts.catalogue import Pin, lookup
from fpcad.make.parts.dimensions import Dimensions
from fpcad.make.parts.mcp_dimensions import AXLE, PIVOT
from fpcad.make.parts.part import Array, Placement, placements

SECTIONS = 48


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

    def placements(self, fingers: Sequence[str]) -> list[Placement]:
        """Where each copy in the hand sits."""
        return placements(self.link, self.places, fingers)


def finger_items(d: Dimensions, fingers: int) -> tuple[BoughtItem, ...]:
    """What one finger needs, counted for all of them."""
    return (_axle(d, fingers), _pivots(d, fingers), _ip_pin(d, fingers), _ip_bearings(d, fingers))


def _axle(d: Dimensions, fingers: int) -> BoughtItem:
    pin = lookup("pins", Pin, AXLE)
    return _pin("mcp_axle", pin, d.mcp.axle_length, "mcp", (_along_y(0.0),), fingers)


def _pivots(d: Dimensions, fingers: int) -> BoughtItem:
    """One pin in the palmar bridge, one in the dorsal bridge; both begin at its inner face."""
    pin, m = lookup("pins", Pin, PIVOT), d.mcp
    length = m.pivot_length
    places = tuple(_along_z(side * (m.bridge_inner + length / 2)) for side in (-1, 1))
    return _pin("mcp_pivot", pin, length, "mcp", places, fingers)


def _ip_pin(d: Dimensions, fingers: int) -> BoughtItem:
    pin = lookup("pins", Pin, f"D{d.knuckle.bearing.bore_mm:g}")
    place = _along_y(0.0)
    place[0, 3] = d.proximal_length
    length = pin.longest(2 * d.knuckle.prong_outer)
    return _pin("ip_pin", pin, length, "proximal", (place,), fingers)


def _ip_bearings(d: Dimensions, fingers: int) -> BoughtItem:
    row, k = d.knuckle.bearing, d.knuckle
    middle = k.bearing_inner + row.width_mm / 2
    places = tuple(_along_y(side * middle) for side in (-1, 1))
    bore = row.bore_mm / 2 / math.cos(math.pi / SECTIONS)  # no facet reaches into the pin
    ring = trimesh.creation.annulus(bore, row.outer_mm / 2, row.width_mm, sections=SECTIONS)
    return BoughtItem(
        "ip_bearing", "bearings", row.size, "distal", places, 2 * fingers, row.mass_g, ring
    )


def _pin(
    name: str, pin: Pin, length: float, link: str, places: tuple[Array, ...], fingers: int
) -> BoughtItem:
    mesh = trimesh.creation.cylinder(pin.diameter_mm / 2, length, sections=SECTIONS)
    count = fingers * len(places)
    mass = pin.mass_g(length)
    return BoughtItem(name, "pins", pin.size, link, places, count, mass, mesh, length)


def _along_z(z: float) -> Array:
    place = np.eye(4)
    place[2, 3] = z
    return place


def _along_y(y: float) -> Array:
    """An item's axis along the link's y, its middle at `y`."""
    place = np.eye(4)
    place[:3, :3] = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    place[1, 3] = y
    return place
