"""Which solids must stay apart, and by how much they do."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, product
from typing import NamedTuple

import casadi as ca

from fpcad.model.distance import Segment, segment_distance_squared
from fpcad.model.frames import Expr, Frame
from fpcad.model.hand import HandTemplate, PalmSolid


class Pair(NamedTuple):
    """Two capsules that must not overlap."""

    name: str
    a: Segment
    b: Segment
    reach: Expr  # sum of the radii [mm]

    def clearance(self) -> Expr:
        """Gap between the surfaces [mm]; negative when they overlap."""
        return ca.sqrt(segment_distance_squared(self.a, self.b)) - self.reach

    def margin(self) -> Expr:
        """(distance^2 - reach^2) / (2 reach) [mm]: smooth, and the gap itself where it vanishes."""
        return (segment_distance_squared(self.a, self.b) - self.reach**2) / (2 * self.reach)


class Body(NamedTuple):
    """A finger's link as a capsule."""

    finger: str
    link: str
    axis: Segment
    radius: Expr


def link_bodies(template: HandTemplate, d: Expr, frames: dict[str, dict[str, Frame]]) -> list[Body]:
    """Capsules of all links of all fingers, in the frame that `frames` are given in."""
    bodies = []
    for finger, links in frames.items():
        for link, frame in links.items():
            shape = template.link_shape(link, d)
            end = frame.point(ca.vertcat(shape.axis_length, 0, 0))
            bodies.append(Body(finger, link, Segment(frame.p, end), shape.radius))
    return bodies


def collision_pairs(
    bodies: list[Body],
    palm: list[PalmSolid],
    tool: Segment,
    tool_radius: float,
    touching: set[tuple[str, str]],
) -> Iterator[Pair]:
    """All pairs that must stay apart, everything in H.

    Finger against finger; tool against every link that does not touch it and against the palm;
    the last link of each finger against the palm's capsules. Neighbours in a chain are exempt.
    """
    for a, b in combinations(bodies, 2):
        if a.finger != b.finger:
            name = f"{a.finger}.{a.link}/{b.finger}.{b.link}"
            yield Pair(name, a.axis, b.axis, a.radius + b.radius)
    for body in bodies:
        if (body.finger, body.link) not in touching:
            yield Pair(
                f"tool/{body.finger}.{body.link}", tool, body.axis, tool_radius + body.radius
            )
    for solid in palm:
        axis = Segment(solid.start, solid.end)
        yield Pair(f"tool/{solid.name}", tool, axis, tool_radius + solid.radius)
    last = {body.finger: body for body in bodies}
    for body, solid in product(last.values(), palm):
        if solid.exempt_finger is None:
            axis = Segment(solid.start, solid.end)
            yield Pair(
                f"{body.finger}.{body.link}/{solid.name}",
                body.axis,
                axis,
                body.radius + solid.radius,
            )
