"""The rigid bones of a finger: clevis and tongue at the IP axis, output discs at the MCP joint."""

from __future__ import annotations

import math

from fpcad.errors import MakeError
from fpcad.make.parts import interlock
from fpcad.make.parts.differential import abduction_plate
from fpcad.make.parts.dimensions import PULLEY_RIM_MM, Dimensions
from fpcad.make.parts.mcp_clearances import (
    arm_outline,
    beyond_pulleys,
    neck_half_width,
    neck_start,
    spoke_back,
)
from fpcad.make.parts.solids import (
    FAR_MM,
    Solid,
    ball,
    behind_bend,
    beyond_flat,
    box,
    extruded,
    finger_core,
    mirrored_at,
    prism,
    rod,
    union,
)

NECK_WIDE_MM, NECK_LEAST_WIDE_MM = 4.2, 2.3
"""Half width of the neck where it meets the shaft."""
NECK_HIGHS_MM = (4.75, 3.4)
"""Half height there: a roof over the channels, or else channels that are open at the top."""
FEATHER_MM = 1.0
"""Around the tongue the shaft ends where it would get thinner than this."""
IP_KNOT_RAD = math.radians(40.0)
"""Angle about the IP axis, from dorsal to the front, at which both IP strands leave their groove."""
KNOT_BEYOND_MM = 5.0
"""From there to the pocket of their knot."""
THIN_MM = 0.8
"""A channel that leaves less wall than this is open to the skin."""


def distal_bone(d: Dimensions) -> Solid:
    """Core of the fingertip in the distal frame; its tongue holds the bearings and is the IP pulley."""
    k = d.knuckle
    shaft = finger_core(d.distal_axis_length, d.bone).cut(beyond_flat(d.flat))
    shaft = shaft.cut(behind_bend(d.ip_flex, d.clearance))
    for side in (-1, 1):
        room = rod((0, side * k.tongue_half, 0), (0, side * FAR_MM, 0), d.bone + d.clearance)
        shaft = shaft.cut(room)
    bone = shaft.fuse(_slab(d, -k.tongue_half, k.tongue_half, 0.0))
    return bone.cut(_ip_groove(d), *_ip_seats(d), *_ip_anchor(d), *interlock.pockets(d, "distal"))


def proximal_bone(d: Dimensions) -> Solid:
    """Proximal bone in the proximal frame: output discs, neck, shaft, clevis at the IP axis."""
    k, x = d.knuckle, d.proximal_length
    bend = mirrored_at(behind_bend(d.ip_flex, d.clearance), x)
    shaft = rod((d.shaft_start, 0, 0), (x, 0, 0), d.bone).cut(beyond_flat(d.flat)).cut(bend)
    slot = k.prong_inner
    shaft = shaft.cut(rod((x, -slot, 0), (x, slot, 0), d.bone + d.clearance))
    shaft = shaft.cut(box((prong_start(d), -slot, -FAR_MM), (x + FAR_MM, slot, FAR_MM)))
    prongs = [_slab(d, k.prong_inner, k.prong_outer, x), _slab(d, -k.prong_outer, -slot, x)]
    bone = shaft.fuse(*prongs, _neck(d), _palmar_disc(d), _dorsal_arm(d))
    pin = rod((x, -FAR_MM, 0), (x, FAR_MM, 0), k.bearing.bore_mm / 2 + d.mcp.hold)
    cuts = [pin, *_channels(d), *_pivot_holes(d), *interlock.pockets(d, "proximal")]
    return bone.cut(*cuts)  # merging faces would break the solid where flat and neck lie close


def prong_start(d: Dimensions) -> float:
    """Where along x of the proximal frame [mm] the clevis's slot goes through: two prongs are left."""
    room = d.bone + d.clearance
    return d.proximal_length - math.sqrt(room**2 - (d.bone - FEATHER_MM) ** 2)


def ip_knot(d: Dimensions) -> tuple[float, float]:
    """Where both IP strands end in the distal bone, (x, z) in the distal frame [mm]."""
    radius = d.ip_pulley - d.mcp.strand / 2
    return radius * math.sin(IP_KNOT_RAD) + KNOT_BEYOND_MM, radius * math.cos(IP_KNOT_RAD)


def ip_tangents(d: Dimensions, side: int) -> tuple[tuple[float, float], tuple[float, float]]:
    """Where the straight strand leaves the drum and meets the IP pulley, (x, z) in the proximal frame.

    `side` is 1 for the extensor (dorsal), -1 for the flexor.
    """
    drum, pulley, length = d.mcp.drum_radius, d.ip_pulley, d.proximal_length
    sine = (pulley - drum) / length
    cosine = math.sqrt(1 - sine**2)
    return (
        (-drum * sine, side * drum * cosine),
        (length - pulley * sine, side * pulley * cosine),
    )


def _slab(d: Dimensions, low: float, high: float, x: float) -> Solid:
    """The part of the knuckle's ball between two planes across the IP axis."""
    return ball((x, 0, 0), d.bone).intersect(box((-FAR_MM, low, -FAR_MM), (FAR_MM, high, FAR_MM)))


def _ip_groove(d: Dimensions) -> Solid:
    """The strands' groove around the tongue, open wherever they come in at some angle of the joint."""
    half, root = d.mcp.groove / 2, d.ip_pulley - d.mcp.strand
    rim = d.ip_pulley + d.mcp.strand + PULLEY_RIM_MM
    if d.bone - rim < FEATHER_MM:
        rim = d.bone + 1.0  # no roof is left over it
    last = math.pi - d.ip_flex[1]  # where the flexor leaves at full flexion, from the dorsal side
    leaving = (rim * math.sin(last), rim * math.cos(last))
    away = (math.cos(d.ip_flex[1]), math.sin(d.ip_flex[1]))  # the finger's proximal axis, seen here
    far = (leaving[0] - FAR_MM * away[0], leaving[1] - FAR_MM * away[1])
    outline = [(0, 0), leaving, far, (-FAR_MM, -FAR_MM), (-FAR_MM, FAR_MM), (0, FAR_MM)]
    ring = rod((0, -half, 0), (0, half, 0), rim).fuse(prism(outline, half))
    return ring.cut(rod((0, -FAR_MM, 0), (0, FAR_MM, 0), root))


def _ip_seats(d: Dimensions) -> list[Solid]:
    k = d.knuckle
    seats = [
        rod(
            (0, side * k.bearing_inner, 0),
            (0, side * FAR_MM, 0),
            k.bearing.outer_mm / 2 + d.mcp.hold,
        )
        for side in (-1, 1)
    ]
    bore = k.bearing.bore_mm / 2 + d.mcp.slip + 0.2  # the pin turns in the bearings alone
    return [*seats, rod((0, -FAR_MM, 0), (0, FAR_MM, 0), bore)]


def _ip_anchor(d: Dimensions) -> list[Solid]:
    """Where both IP strands end: a hole from the groove's dorsal front to a knot's pocket."""
    end, z = ip_knot(d)
    hole = rod((end - KNOT_BEYOND_MM - 0.5, 0, z), (end, 0, z), 0.6)
    return [hole, rod((end, 0, z - 0.6), (end, 0, FAR_MM), 1.4)]


def _channels(d: Dimensions) -> list[Solid]:
    """Straight ways of the two IP strands through neck and shaft; open to the skin where it is near."""
    found = []
    for side in (-1, 1):
        (x0, z0), (x1, z1) = ip_tangents(d, side)
        slope = (z1 - z0) / (x1 - x0)
        near = d.mcp.disc_rim  # before the neck begins
        start, end = (near, z0 + slope * (near - x0)), (x1, z1)
        found.append(rod((start[0], 0, start[1]), (end[0], 0, end[1]), d.channel))
        if d.bone - max(abs(z0), abs(z1)) - d.channel < THIN_MM:
            outline = [start, end, (x1, side * FAR_MM), (d.shaft_start, side * FAR_MM)]
            outline[0] = (d.shaft_start, z0 + slope * (d.shaft_start - x0))
            found.append(prism(outline, d.channel))
    return found


def _neck(d: Dimensions) -> Solid:
    """The blade that joins discs and shaft; abducted, it passes between the input pulleys."""
    m, ball_radius = d.mcp, d.root - d.clearance
    half = neck_half_width(m, d.widest_abduction)
    start = neck_start(m)
    blade = box((start, -half, -m.hub_outer), (d.shaft_start, half, m.hub_outer))
    blade = blade.intersect(ball((0, 0, 0), ball_radius))
    wide, high = _neck_section(d)
    beyond = beyond_pulleys(m, d.widest_abduction, half)
    first = beyond_pulleys(m, d.widest_abduction, wide)
    end = d.shaft_start + 2.0
    outline = [
        (first, wide),
        (end, wide),
        (end, -wide),
        (first, -wide),
        (beyond, -half),
        (beyond, half),
    ]
    return blade.fuse(box((start, -half, -high), (end, half, high)), _plate(outline, high))


def _neck_section(d: Dimensions) -> tuple[float, float]:
    """Half width and half height of the neck at the shaft: well above the tendons' channels or below."""
    for high in NECK_HIGHS_MM:
        if d.bone >= math.hypot(NECK_LEAST_WIDE_MM, high):
            return min(0.7 * d.bone, NECK_WIDE_MM, math.sqrt(d.bone**2 - high**2)), high
    raise MakeError(f"proximal bone: a neck needs a bone of radius 4.1 mm, it has {d.bone:.2f} mm")


def _plate(outline_xy: list[tuple[float, float]], half_height: float) -> Solid:
    lying = prism([(x, y) for x, y in outline_xy], half_height)
    return lying.rotate((0, 0, 0), (1, 0, 0), -90)


def _palmar_disc(d: Dimensions) -> Solid:
    """The output pulley, fixed to the bone: its plate, a hub on the pin, a bar to the neck."""
    m = d.mcp
    hub = rod((0, 0, -m.disc_inner), (0, 0, -m.hub_outer), m.boss)
    bar = _bar(d, -m.hub_outer, -m.disc_lip, 0.0)
    return union(
        [
            abduction_plate(d, -1),
            hub,
            bar,
            _arm(d, -m.hub_outer, -m.pulley_rim - m.gap),
        ]
    )


def _dorsal_arm(d: Dimensions) -> Solid:
    """Hub on the dorsal pin above the idler, a bar, and a step down to the neck in front of it."""
    m = d.mcp
    hub = rod((0, 0, m.arm_inner), (0, 0, m.arm_outer), m.boss)
    step = _bar(d, m.bridge_outer + m.gap, m.arm_outer, m.disc_rim + m.gap)
    return union([hub, _arm(d, m.arm_inner, m.arm_outer), step])


def _arm(d: Dimensions, low: float, high: float) -> Solid:
    """What carries a hub's load to the neck, where no pulley is in the way.

    The palm leaves it the cavity about the flexion axis, and beyond that the neck's room.
    """
    arm = extruded(arm_outline(d.mcp, d.widest_abduction), low, high)
    cavity = rod((0, -FAR_MM, 0), (0, FAR_MM, 0), d.mcp.cavity - d.mcp.gap)
    neck = box((-FAR_MM, -d.neck_room, -FAR_MM), (FAR_MM, d.neck_room, FAR_MM))
    arm = arm.intersect(cavity.fuse(neck))
    return arm.fuse(_bar(d, low, high, 0.0)).intersect(ball((0, 0, 0), d.root - d.clearance))


def _bar(d: Dimensions, low: float, high: float, start: float) -> Solid:
    half = neck_half_width(d.mcp, d.widest_abduction)
    wide = max(start, spoke_back(d.mcp, d.widest_abduction))
    hub = min(half, d.mcp.boss)
    bar = box((start, -hub, low), (d.root, hub, high)).fuse(
        box((wide, -half, low), (d.root, half, high))
    )
    return bar.intersect(ball((0, 0, 0), d.root - d.clearance))


def _pivot_holes(d: Dimensions) -> list[Solid]:
    m = d.mcp
    return [rod((0, 0, side), (0, 0, side * FAR_MM), m.pivot + m.slip) for side in (-1, 1)]
