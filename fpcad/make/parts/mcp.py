"""The MCP cross: carries the abduction axis (z) while it turns about the flexion axis (y)."""

from __future__ import annotations

from fpcad.make.parts.dimensions import Dimensions
from fpcad.make.parts.solids import Solid, box, rod

PIN_BOTTOM_MM = 0.9  # wall between the through hole of flexion and the stub holes of abduction


def mcp_cross(d: Dimensions) -> Solid:
    """A cube about the root, in the frame that flexion carries, with holes for the pins."""
    h = d.hub
    cube = box((-h, -h, -h), (h, h, h))
    through = rod((0, -2 * h, 0), (0, 2 * h, 0), d.pin_hole)
    bottom = d.pin_hole + PIN_BOTTOM_MM
    stubs = [rod((0, 0, side * bottom), (0, 0, side * 2 * h), d.pin_hole) for side in (-1, 1)]
    return cube.cut(through, *stubs)
