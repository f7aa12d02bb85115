"""The tensioner of a loop: a carriage that holds the extensor's tube, drawn forwards by one screw.

docs/parts.md, "Motor box". Its frame: z into the box along the strand, from the carriage's front; the
strand at the origin, the screw beside it at +y.
"""

from __future__ import annotations

from dataclasses import dataclass

from fpcad.make.parts.catalogue import Insert, Screw, Tendon, Tube, lookup
from fpcad.make.parts.mcp_dimensions import LIP_EXTRA_MM, TENDON
from fpcad.make.parts.routing import TUBE
from fpcad.make.parts.solids import Solid, box, rod
from fpcad.spec.hardware import Print

SCREW = "M3"
LENGTH_MM = 7.0
TRAVEL_MM = 6.5
BRIDGE_MM = 3.0
"""Thickness of what the screw's head pulls against."""
SEAT_MM = 5.0
"""How deep the tube sits in the carriage."""
STRAND_GAP_MM = 0.3
"""What a strand's way is wider than the strand, in radius."""


@dataclass(frozen=True)
class Carriage:
    """Lengths [mm] of a carriage and of the room that it slides in."""

    tube: float
    """Radius of the tube's seat."""
    tube_pass: float
    """Radius of the hole that the tube slides through."""
    strand_way: float
    """Radius of the strand's way."""
    insert: float
    """Radius of the heat-set insert's hole."""
    insert_depth: float
    insert_wall: float
    """Least wall about the insert."""
    screw: float
    """Radius of the screw's clearance hole."""
    wall: float
    clearance: float

    @property
    def screw_y(self) -> float:
        """From the strand to the screw."""
        return self.tube + self.insert_wall + self.insert

    @property
    def half_width(self) -> float:
        """Half width in x."""
        return self.insert + self.insert_wall

    @property
    def low(self) -> float:
        """Least y."""
        return -(self.tube + self.wall)

    @property
    def high(self) -> float:
        """Largest y."""
        return self.screw_y + self.insert + self.insert_wall

    @property
    def room_end(self) -> float:
        """From the bridge's front to the carriage's back when the loop is slackest."""
        return BRIDGE_MM + TRAVEL_MM + LENGTH_MM

    @property
    def screw_length(self) -> float:
        """Length of the screw: it holds the insert from end to end of the travel."""
        return lookup("screws", Screw, SCREW).shortest(self.room_end)


def carriage_dimensions(settings: Print) -> Carriage:
    """Lengths of the carriage that the print settings ask for."""
    tube, insert = lookup("tubes", Tube, TUBE), lookup("inserts", Insert, SCREW)
    tendon, screw = lookup("tendons", Tendon, TENDON), lookup("screws", Screw, SCREW)
    return Carriage(
        tube=(tube.outer_mm + settings.hold_mm) / 2,
        tube_pass=tube.outer_mm / 2 + settings.clearance_mm,
        strand_way=tendon.diameter_mm / 2 + STRAND_GAP_MM,
        insert=insert.hole_mm / 2,
        insert_depth=insert.length_mm,
        insert_wall=insert.least_wall_mm + (insert.outer_mm - insert.hole_mm) / 2,
        screw=screw.clearance_hole_mm / 2,
        wall=settings.bone_wall_mm + LIP_EXTRA_MM,
        clearance=settings.clearance_mm,
    )


def carriage_solid(c: Carriage) -> Solid:
    """The carriage in its frame; its insert is melted in from the back, so that the screw draws it inwards."""
    body = box((-c.half_width, c.low, 0), (c.half_width, c.high, LENGTH_MM))
    seat = rod((0, 0, -1), (0, 0, SEAT_MM), c.tube)
    way = rod((0, 0, 0), (0, 0, LENGTH_MM + 1), c.strand_way)
    screw = rod((0, c.screw_y, -1), (0, c.screw_y, LENGTH_MM), c.screw)
    start = LENGTH_MM - c.insert_depth
    insert = rod((0, c.screw_y, start), (0, c.screw_y, LENGTH_MM + 1), c.insert)
    return body.cut(seat, way, screw, insert).clean()


def carriage_room(c: Carriage, bridge: float, end: float) -> list[Solid]:
    """What the front plate leaves free for a carriage: its room, and holes for tube and screw.

    In the frame of a carriage at z = 0; the room reaches from `bridge` to `end` [mm].
    """
    half, low = c.half_width + c.clearance, c.low - c.clearance
    room = box((-half, low, bridge), (half, c.high + c.clearance, end))
    tube = rod((0, 0, -1), (0, 0, bridge + 1), c.tube_pass)
    return [room, tube, rod((0, c.screw_y, -1), (0, c.screw_y, bridge + 1), c.screw)]
