"""Lengths of the MCP differential: what sits where along the flexion axis (y) and the abduction axis (z).

From the root outwards along y: drum of the IP strands, cheek of the cross, input pulley, ear of the
palm. From the root outwards along z: drum, bridge of the cross, output disc of the proximal bone.
docs/parts.md, "The differential".
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from fpcad.make.parts.catalogue import Pin, Tendon, lookup
from fpcad.spec.hardware import Print
from fpcad.spec.hardware import Transmission as Routing

TENDON = "DYNEEMA-0.6"
AXLE = "D3"
PIVOT = "D2"
PIVOT_WALL_MM = 1.0
"""Around the abduction pins: what is thicker meets the IP strands beside it."""
RELIEF_MM = 0.1
"""Pulley and output disc hand the strand over at one point, so both stop this short of it."""
LIP_EXTRA_MM = 0.05
"""Beyond the least wall, so that rounding in meshes does not make a lip too thin."""
EAR_LEAST_MM, EAR_MOST_MM = 1.1, 3.0
"""How far the axle stands in the palm's ears: what is always there, and what is enough."""
AXLES_APART_MM = 0.2
"""Between the axles of fingers side by side."""
HUB_MM = 3.6
"""Length of an output disc's hub on its pin."""
ARM_MM = 2.0
"""Length of the dorsal arm's hub on its pin."""
PIVOT_HOLD_MM = 2.0
"""Length of a pin in the bridge."""
SPOOL_TURN_RAD = math.radians(340.0)
"""Most that one groove takes up of one strand."""


@dataclass(frozen=True)
class Mcp:
    """Radii and places [mm] of one finger's differential. Pitch radii are those of a strand's core."""

    input_radius: float
    """Pitch radius of both input pulleys."""
    output_radius: float
    """Pitch radius of both output discs."""
    drum_radius: float
    """Pitch radius of the drum that leads the IP strands across."""
    strand: float
    """Radius of a tendon."""
    lip: float
    """Thickness of the walls beside grooves."""
    gap: float
    axle: float
    """Radius of the flexion axle."""
    pivot: float
    """Radius of the abduction pins."""
    slip: float
    """What a turning hole is larger than its pin, in radius."""
    hold: float
    """What a holding hole is larger than its pin, in radius."""
    ear: float = EAR_LEAST_MM
    """How far the axle may stand in an ear."""

    @property
    def groove(self) -> float:
        """Width of a groove."""
        return 2 * self.strand + self.gap

    @property
    def boss(self) -> float:
        """Radius about the abduction axis, and half width in y, of all that holds its pins."""
        return self.pivot + PIVOT_WALL_MM

    @property
    def drum_side(self) -> float:
        """The motor's strands lie on the drum at this |y|, just beside the bosses."""
        return self.boss + self.gap + self.strand

    @property
    def drum_half(self) -> float:
        """Half width of the drum."""
        return self.drum_side + self.groove / 2 + self.lip

    @property
    def cheek_inner(self) -> float:
        """Inner |y| of the cross's cheeks."""
        return self.drum_half + self.gap

    @property
    def cheek_outer(self) -> float:
        """Outer |y| of the cross's cheeks."""
        return self.pulley_inner - self.gap

    @property
    def pulley_inner(self) -> float:
        """Inner |y| of the input pulleys, where their transfer groove begins."""
        return self.output_radius - self.strand + RELIEF_MM

    @property
    def pulley_lip(self) -> float:
        """|y| at which the lip between the two grooves begins."""
        return self.output_radius + self.strand + RELIEF_MM

    @property
    def pulley_side(self) -> float:
        """|y| of the motor's strands on the input pulleys."""
        return self.pulley_lip + self.lip + self.groove / 2

    @property
    def pulley_outer(self) -> float:
        """Outer |y| of the input pulleys."""
        return self.pulley_side + self.groove / 2 + self.lip

    @property
    def pulley_rim(self) -> float:
        """Radius of the lips of the input pulleys."""
        return self.input_radius + self.strand - RELIEF_MM

    @property
    def drum_rim(self) -> float:
        """Radius of the lips of the drum."""
        return self.drum_radius + self.strand + RELIEF_MM

    @property
    def ear_inner(self) -> float:
        """Inner |y| of the palm's ears."""
        return self.pulley_outer + self.gap

    @property
    def ear_outer(self) -> float:
        """Outer |y| of what an axle may use of the palm's ears."""
        return self.ear_inner + self.ear

    @property
    def bridge_inner(self) -> float:
        """Inner |z| of the cross's bridges, above the strands on the drum."""
        return self.drum_rim + self.gap

    @property
    def bridge_outer(self) -> float:
        """Outer |z| of the cross's bridges."""
        return self.disc_inner - self.gap

    @property
    def disc_inner(self) -> float:
        """Inner |z| of the output discs, where their groove begins."""
        return self.input_radius - self.strand + RELIEF_MM

    @property
    def disc_lip(self) -> float:
        """|z| at which the discs' lip begins."""
        return self.input_radius + self.strand + RELIEF_MM

    @property
    def disc_outer(self) -> float:
        """Outer |z| of the output discs."""
        return self.disc_lip + self.lip

    @property
    def disc_rim(self) -> float:
        """Radius of the discs' lip."""
        return self.output_radius + self.strand - RELIEF_MM

    @property
    def hub_outer(self) -> float:
        """Outer |z| of the discs' hubs, and end of the pins."""
        return self.disc_inner + HUB_MM

    @property
    def arm_inner(self) -> float:
        """Inner z of the proximal bone's dorsal arm, above the idler."""
        return self.disc_outer + self.gap

    @property
    def arm_outer(self) -> float:
        """Outer z of the dorsal arm, and end of its pin."""
        return self.arm_inner + ARM_MM

    @property
    def cavity(self) -> float:
        """Radius about the flexion axis of all that turns between the palm's ears, and a gap."""
        hub = math.hypot(max(self.hub_outer, self.arm_outer), self.boss)
        horn = math.hypot(self.disc_outer, self.horn_back)
        return max(hub, horn, self.pulley_rim) + self.gap

    @property
    def horn_back(self) -> float:
        """How far the discs' groove reaches back behind the abduction axis."""
        return 0.4 * self.output_radius

    @property
    def cross_front(self) -> float:
        """Front of the cross's bridges and cheeks."""
        return 5.4

    @property
    def cross_reach(self) -> float:
        """Radius about the abduction axis that all of the cross keeps within: the neck begins there."""
        return self.disc_rim + self.gap

    @property
    def bar_back(self) -> float:
        """Back of the bridges beside the bosses: the IP strands pass behind it."""
        return 3.0

    @property
    def axle_length(self) -> float:
        """Length of the flexion axle, as pins are sold."""
        return lookup("pins", Pin, AXLE).longest(2 * self.ear_outer)

    @property
    def axle_seat(self) -> float:
        """How far the axle stands in each ear."""
        return self.axle_length / 2 - self.ear_inner

    @property
    def pivot_length(self) -> float:
        """Length of both abduction pins, which begin at the bridges' inner faces."""
        shorter = min(self.hub_outer, self.arm_outer)
        return lookup("pins", Pin, PIVOT).longest(shorter - self.bridge_inner)

    @property
    def pivot_outer(self) -> float:
        """|z| of the abduction pins' outer ends."""
        return self.bridge_inner + self.pivot_length

    @property
    def widest_half(self) -> float:
        """Half of the room along y that one finger's root takes up."""
        return self.ear_inner + EAR_LEAST_MM


def mcp_dimensions(routing: Routing, settings: Print, apart: float = 0.0) -> Mcp:
    """Lengths of the differential that a spec's routing and print settings ask for.

    `apart` [mm] is the distance of the nearest fingers side by side.
    """
    tendon = lookup("tendons", Tendon, TENDON)
    axle, pivot = lookup("pins", Pin, AXLE), lookup("pins", Pin, PIVOT)
    sizes = Mcp(
        input_radius=routing.input_pulley_radius_mm,
        output_radius=routing.output_pulley_radius_mm,
        drum_radius=routing.idler_radius_mm,
        strand=tendon.diameter_mm / 2,
        lip=settings.bone_wall_mm + LIP_EXTRA_MM,
        gap=settings.clearance_mm,
        axle=axle.diameter_mm / 2,
        pivot=pivot.diameter_mm / 2,
        slip=settings.slip_mm / 2,
        hold=settings.hold_mm / 2,
    )
    free = (apart - AXLES_APART_MM) / 2 - sizes.ear_inner
    return replace(sizes, ear=min(max(free, EAR_LEAST_MM), EAR_MOST_MM))
