"""Every length that the parts of one hand share, derived from the design in one place. docs/parts.md."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fpcad.errors import MakeError
from fpcad.make.parts import mcp_clearances
from fpcad.make.parts import mcp_dimensions as mcp
from fpcad.make.parts.catalogue import Bearing, lookup
from fpcad.make.parts.knuckle import Knuckle, finger_needed, knuckle
from fpcad.model.geometry import HandGeometry
from fpcad.spec.base import Interval
from fpcad.spec.schema import Spec
from fpcad.units import RAD_PER_DEG

CHANNEL_GAP_MM = 0.3
"""What a tendon's channel is wider than the tendon, in radius."""
PULLEY_RIM_MM = 0.15
"""What the IP pulley's rim stands out beyond the strand's core."""
ROOF_MM = 7.5
"""Thickness of the palm's dorsal roof, which no link's sweep enters: it holds the palm together."""
ANCHOR_MARGIN_RAD = math.radians(12.0)
"""Wrap that a strand keeps before its anchor, at the end of its range."""
FLAT_MM = 0.3
"""How far the flat is cut into a bone's round shaft on which it lies when it is printed."""


@dataclass(frozen=True)
class Dimensions:
    """Lengths [mm] and joint ranges [rad] of a finger; all fingers of a hand are alike."""

    proximal_length: float
    """From the root to the IP axis."""
    distal_axis_length: float
    """From the IP axis to the centre of the fingertip's hemisphere."""
    skin_outer: float
    """Radius of the skin's outer surface: the contact capsule, enlarged if the spec says so."""
    skin_inner: float
    """Radius of the skin's bore."""
    bone: float
    """Radius of the bones' shafts."""
    root: float
    """Radius of the sphere around the root in which the MCP joint lies."""
    clearance: float
    """Gap between parts that move against each other."""
    ip_pulley: float
    """Pitch radius of the IP joint's pulley."""
    knuckle: Knuckle
    mcp: mcp.Mcp
    mcp_flex: Interval
    mcp_abd: Interval
    ip_flex: Interval

    @property
    def shaft_start(self) -> float:
        """Distance from the root at which the proximal bone's shaft and skin begin."""
        return self.root + self.clearance

    @property
    def flat(self) -> float:
        """-y of the flat on which a bone's shaft lies when it is printed; the skin fills what it lacks."""
        return self.bone - FLAT_MM

    @property
    def neck_room(self) -> float:
        """Half width of what the palm leaves to the neck on its whole way between the ears."""
        return 0.7 * self.bone

    @property
    def widest_abduction(self) -> float:
        """Largest abduction to either side [rad]."""
        return max(abs(angle) for angle in self.mcp_abd)

    @property
    def channel(self) -> float:
        """Radius of a tendon's channel."""
        return self.mcp.strand + CHANNEL_GAP_MM


def finger_dimensions(spec: Spec, geometry: HandGeometry) -> Dimensions:
    """Dimensions of a hand's fingers; raises :class:`MakeError` when a part has no room."""
    found = reasons(spec, geometry)
    if found:
        raise MakeError(f"finger: {found[0]}")
    settings, radius = spec.print, geometry.radius_mm
    limits = _limits(spec)
    bone = _bone(spec, geometry)
    joint = knuckle(bone, settings.clearance_mm)
    assert joint is not None  # told by reasons otherwise
    return Dimensions(
        proximal_length=geometry.proximal_length_mm,
        distal_axis_length=geometry.distal_length_mm - radius,
        skin_outer=radius + settings.skin_oversize_mm,
        skin_inner=radius - settings.skin_thickness_mm,
        bone=bone,
        root=min(_root_radii(geometry).values()),
        clearance=settings.clearance_mm,
        ip_pulley=spec.motors.transmission.ip_pulley_radius_mm,
        knuckle=joint,
        mcp=mcp.mcp_dimensions(spec.motors.transmission, settings, _apart(geometry)),
        mcp_flex=limits["mcp_flex"],
        mcp_abd=limits["mcp_abd"],
        ip_flex=limits["ip_flex"],
    )


def roof_height(geometry: HandGeometry) -> float:
    """Height z [mm] in H up to which the fingers' cavities may reach."""
    tops = [max(s.start_mm[2], s.end_mm[2]) + s.radius_mm for s in geometry.palm]
    return float(max(tops)) - ROOF_MM


def reasons(spec: Spec, geometry: HandGeometry) -> list[str]:
    """Why a hand cannot hold its hardware, in figures; nothing where it can. No solid is modelled."""
    bone = _bone(spec, geometry)
    return [
        *_knuckle_reasons(spec, geometry, bone),
        *_pulley_reasons(spec, bone),
        *_root_reasons(spec, geometry),
        *_link_reasons(spec, geometry),
    ]


def _bone(spec: Spec, geometry: HandGeometry) -> float:
    return geometry.radius_mm - spec.print.skin_thickness_mm - spec.print.clearance_mm


def _limits(spec: Spec) -> dict[str, Interval]:
    return {
        joint: (low * RAD_PER_DEG, high * RAD_PER_DEG)
        for joint, (low, high) in spec.hand.joint_limits_deg.items()
    }


def _knuckle_reasons(spec: Spec, geometry: HandGeometry, bone: float) -> list[str]:
    settings = spec.print
    if knuckle(bone, settings.clearance_mm) is not None:
        return []
    smallest = lookup("bearings", Bearing, "BUSH-2")
    needs = finger_needed(smallest, settings.clearance_mm, settings.skin_thickness_mm)
    return [
        f"bearing {smallest.size} needs {needs:.1f} mm, finger is {2 * geometry.radius_mm:.1f} mm"
    ]


def _pulley_reasons(spec: Spec, bone: float) -> list[str]:
    routing, found = spec.motors.transmission, []
    strand = mcp.mcp_dimensions(routing, spec.print).strand
    around = 2 * (spec.print.skin_thickness_mm + spec.print.clearance_mm)
    needs = 2 * (routing.ip_pulley_radius_mm + PULLEY_RIM_MM) + around
    if needs > 2 * bone + around + 1e-9:
        found.append(
            f"IP pulley of radius {routing.ip_pulley_radius_mm:g} mm needs {needs:.1f} mm, "
            f"finger is {2 * bone + around:.1f} mm"
        )
    joint = knuckle(bone, spec.print.clearance_mm)
    if joint is not None:
        room = routing.ip_pulley_radius_mm - strand - joint.bearing.bore_mm / 2
        if room < 0.8:
            found.append(f"IP pulley leaves {room:.2f} mm around its pin, 0.8 mm are needed")
    span = _limits(spec)["ip_flex"]
    turn = routing.ip_pulley_radius_mm / max(routing.idler_radius_mm, 1e-9) * (span[1] - span[0])
    if turn > math.pi - 2 * ANCHOR_MARGIN_RAD:
        found.append(
            f"the drum across the MCP joint turns {math.degrees(turn):.0f} deg for the IP joint, "
            f"its groove takes up {math.degrees(math.pi - 2 * ANCHOR_MARGIN_RAD):.0f} deg"
        )
    return found


def _root_reasons(spec: Spec, geometry: HandGeometry) -> list[str]:
    radii, found = _root_radii(geometry), []
    sizes = mcp.mcp_dimensions(spec.motors.transmission, spec.print)
    low, high = _limits(spec)["mcp_abd"]
    for finger in geometry.fingers:
        if finger not in radii:
            found.append(f"hand.palm: {finger} has no sphere at its root for its MCP joint")
    if radii:
        found += mcp_clearances.reasons(sizes, min(radii.values()), max(abs(low), abs(high)))
    for a, b, apart in _neighbours(geometry):
        if apart < 2 * sizes.widest_half:
            found.append(
                f"the MCP joints of {a} and {b} need {2 * sizes.widest_half:.1f} mm between roots, "
                f"they are {apart:.1f} mm apart"
            )
    return found


def _root_radii(geometry: HandGeometry) -> dict[str, float]:
    """Radius [mm] about each finger's root that lies wholly in its sphere: all of its MCP joint turns there."""
    return {
        shape.finger: shape.radius_mm
        - math.dist(shape.start_mm, geometry.T_palm_root[shape.finger][:3, 3])
        for shape in geometry.palm
        if shape.finger
    }


def _neighbours(geometry: HandGeometry) -> list[tuple[str, str, float]]:
    """Fingers whose flexion axes lie side by side on one line, and the distance of their roots."""
    found = []
    poses = geometry.T_palm_root
    for a in geometry.fingers:
        for b in geometry.fingers:
            step = poses[b][:3, 3] - poses[a][:3, 3]
            along = float(step @ poses[a][:3, 1])
            if along > 0 and abs(along) > 0.99 * math.hypot(*step):
                found.append((a, b, along))
    nearest = sorted(found, key=lambda pair: pair[2])
    return [pair for pair in nearest if pair[2] < 1.5 * nearest[0][2]]


def _apart(geometry: HandGeometry) -> float:
    """Distance [mm] of the nearest fingers side by side; without any there is all the room."""
    return min((apart for _, _, apart in _neighbours(geometry)), default=math.inf)


def _link_reasons(spec: Spec, geometry: HandGeometry) -> list[str]:
    radius = geometry.radius_mm + spec.print.skin_oversize_mm
    start = min(_root_radii(geometry).values(), default=0.0) + spec.print.clearance_mm
    end = geometry.proximal_length_mm - radius * math.tan(_limits(spec)["ip_flex"][1] / 2)
    if end < start + 1.0:
        return [
            f"at full IP flexion the bend plane leaves no proximal skin between {start:.1f} mm "
            f"and {end:.2f} mm"
        ]
    return []
