"""Room that the palm's body and its pad leave to the links: their grooves, and the roof that ends them."""

from __future__ import annotations

import math

from fpcad.make.parts.dimensions import Dimensions, roof_height
from fpcad.make.parts.solids import FAR_MM, Solid, box, swept_link
from fpcad.model.geometry import HandGeometry
from fpcad.spec.base import Interval


def below_roof(geometry: HandGeometry, higher: float = 0.0) -> Solid:
    """All below the roof, or up to `higher` [mm] into it."""
    return box((-FAR_MM,) * 3, (FAR_MM, FAR_MM, roof_height(geometry) + higher))


def link_room(d: Dimensions, abduction: Interval, far: float, wider: float = 0.0) -> Solid:
    """What the proximal link with its skin passes, up to a distance `far` from the root.

    `wider` [mm] is added all around. In the root's frame.
    """
    half = d.skin_outer + d.clearance + wider
    widest = max(abs(angle) for angle in abduction)
    near = d.shaft_start * math.cos(widest) - half * math.sin(widest)
    return swept_link((max(near, 0.0), far + wider), half, half, d.mcp_flex, abduction)
