"""Gate: what is fixed to one link does not share room, but for tight fits and threads."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from fpcad.make.gates.bodies import Body
from fpcad.make.gates.bounds import box_gap
from fpcad.make.gates.finding import Finding, Severity, point
from fpcad.make.gates.meeting import LEAST_SEARCH_MM, meet
from fpcad.model.geometry import HandGeometry

GATE = "fixed"
TIGHT_SHARE = 0.35
"""Of a bought item's volume, so much may lie inside printed parts: threads, inserts, tight fits."""


def check_fixed(bodies: Sequence[Body], geometry: HandGeometry) -> list[Finding]:
    """Overlaps of what one link carries; the links of the first finger stand for all."""
    found = []
    here = np.eye(4)
    for a, b in combinations(bodies, 2):
        if (a.finger, a.link) != (b.finger, b.link) or a.finger not in (None, geometry.fingers[0]):
            continue
        if a.bought and b.bought:  # screws sit in inserts, pins in bearings
            continue
        if box_gap(a.box, b.box) > LEAST_SEARCH_MM:
            continue
        _, shared = meet(a, here, b, here, LEAST_SEARCH_MM)
        if shared is None:
            continue
        allowed = max((TIGHT_SHARE * c.solid.volume() for c in (a, b) if c.bought), default=0.0)
        if shared.volume_mm3 > allowed:
            pair, volume = f"{a.name} and {b.name}", shared.volume_mm3
            text = f"they share {volume:.3g} mm^3, {allowed:.3g} mm^3 is allowed"
            where = point(shared.at_mm)
            found.append(Finding(GATE, Severity.ERROR, pair, volume, allowed, "mm^3", text, where))
    return found
