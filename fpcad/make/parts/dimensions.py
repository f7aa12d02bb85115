"""Every length that the parts of one hand share, derived from the design in one place. docs/parts.md."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fpcad.errors import MakeError
from fpcad.model.geometry import HandGeometry
from fpcad.spec.base import Interval
from fpcad.spec.schema import Spec
from fpcad.units import RAD_PER_DEG

PIN_RADIUS_MM = 1.0
PIN_WALL_MM = 0.8  # two lines of a common 0.4 mm nozzle around a pin's hole
LEAST_ROOT_RADIUS_MM = 10.0  # below it the MCP cross has no room for its pins


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
    mcp_flex: Interval
    mcp_abd: Interval
    ip_flex: Interval

    @property
    def pin_hole(self) -> float:
        """Radius of the pins' holes."""
        return PIN_RADIUS_MM + self.clearance / 2

    @property
    def ip_disc(self) -> float:
        """Radius of the knuckle's discs around the IP axis."""
        return 0.7 * self.bone

    @property
    def ip_half_width(self) -> float:
        """Half width of the knuckle: the discs just stay inside the bore of either skin."""
        return math.sqrt(self.bone**2 - self.ip_disc**2)

    @property
    def tongue_half_width(self) -> float:
        """Half width of the distal bone's tongue between the proximal bone's prongs."""
        return 0.5 * self.ip_half_width - self.clearance

    @property
    def hub(self) -> float:
        """Half edge of the MCP cross; radius of the discs of the proximal bone's fork."""
        return self.root / 3

    @property
    def fork_inner(self) -> float:
        """Distance of the fork's prongs from the flexion plane."""
        return self.hub + self.clearance

    @property
    def fork_outer(self) -> float:
        """Outer distance of the fork's prongs from the flexion plane."""
        return self.fork_inner + self.root / 4

    @property
    def neck_half_width(self) -> float:
        """Half width of the proximal bone where it passes between the palm's ears."""
        return min(0.65 * self.bone, self.hub)

    @property
    def neck_start(self) -> float:
        """Distance from the root beyond which the neck is clear of the abducting cross."""
        return math.sqrt(2) * self.hub + self.clearance

    @property
    def shaft_start(self) -> float:
        """Distance from the root at which the proximal bone's shaft and skin begin."""
        return self.root + self.clearance

    @property
    def mcp_cavity(self) -> float:
        """Radius about the flexion axis of all that turns inside the palm's ears."""
        return math.hypot(self.fork_outer, self.hub) + self.clearance


def finger_dimensions(spec: Spec, geometry: HandGeometry) -> Dimensions:
    """Dimensions of a hand's fingers; raises :class:`MakeError` when a part has no room."""
    settings, radius = spec.print, geometry.radius_mm
    limits = {
        joint: (low * RAD_PER_DEG, high * RAD_PER_DEG)
        for joint, (low, high) in spec.hand.joint_limits_deg.items()
    }
    dimensions = Dimensions(
        proximal_length=geometry.proximal_length_mm,
        distal_axis_length=geometry.distal_length_mm - radius,
        skin_outer=radius + settings.skin_oversize_mm,
        skin_inner=radius - settings.skin_thickness_mm,
        bone=radius - settings.skin_thickness_mm - settings.clearance_mm,
        root=_root_radius(geometry),
        clearance=settings.clearance_mm,
        mcp_flex=limits["mcp_flex"],
        mcp_abd=limits["mcp_abd"],
        ip_flex=limits["ip_flex"],
    )
    _check_room(dimensions)
    return dimensions


def _root_radius(geometry: HandGeometry) -> float:
    radii = {shape.finger: shape.radius_mm for shape in geometry.palm if shape.finger}
    for finger in geometry.fingers:
        if radii.get(finger, 0.0) < LEAST_ROOT_RADIUS_MM:
            raise MakeError(
                f"hand.palm: {finger} has no sphere of at least {LEAST_ROOT_RADIUS_MM:g} mm at "
                f"its root, where its MCP joint must fit"
            )
    return min(radii[finger] for finger in geometry.fingers)


def _check_room(dimensions: Dimensions) -> None:
    least = (dimensions.pin_hole + PIN_WALL_MM) / 0.7
    if dimensions.bone < least:
        raise MakeError(
            f"finger: skin and clearance leave a bone of radius {dimensions.bone:g} mm; "
            f"the IP pin needs {least:.2f} mm"
        )
    bend = dimensions.skin_outer * math.tan(dimensions.ip_flex[1] / 2)
    if dimensions.proximal_length - bend < dimensions.shaft_start + 1.0:
        raise MakeError(
            f"finger: at full IP flexion the bend plane leaves no proximal skin between "
            f"{dimensions.shaft_start:g} mm and {dimensions.proximal_length - bend:.2f} mm"
        )
