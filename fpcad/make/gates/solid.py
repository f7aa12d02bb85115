"""Gate: the solid is a valid boundary representation of one body."""

from __future__ import annotations

from fpcad.make.gates.finding import Finding, Severity, point
from fpcad.make.parts.solids import Solid

GATE = "solid"


def check_solid(part: str, solid: Solid) -> list[Finding]:
    """Findings about the modelling kernel's own judgement of a part's solid."""
    found = []
    if not solid.isValid():
        centre = point(solid.BoundingBox().center.toTuple())
        text = "its boundary representation is not valid"
        found.append(Finding(GATE, Severity.ERROR, part, 0.0, 1.0, "", text, centre))
    bodies = solid.Solids()
    if len(bodies) != 1:
        smallest = min(bodies, key=lambda body: body.Volume(), default=None)
        where = None if smallest is None else point(smallest.Center().toTuple())
        text = f"{len(bodies)} bodies instead of one"
        found.append(Finding(GATE, Severity.ERROR, part, len(bodies), 1, "bodies", text, where))
    return found
