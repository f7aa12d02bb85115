"""The spool on a motor's horn: both strands of one loop, wound oppositely. docs/parts.md, "Motor box".

Its frame, which is the motor's: z along the shaft outwards from the horn's face, y from the shaft to the
motor's far end. Both strands leave towards -y: the flexor at +x, the extensor at -x, as the motor
stands in the middle of its travel. Turning about +z winds up the flexor.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fpcad.errors import MakeError
from fpcad.make.parts.catalogue import MotorBody, Screw, Tendon, lookup
from fpcad.make.parts.mcp_dimensions import LIP_EXTRA_MM, TENDON
from fpcad.make.parts.solids import Solid, rod
from fpcad.model.transmission import finger_transmission
from fpcad.spec.schema import Spec
from fpcad.spec.templates import TEMPLATES
from fpcad.units import RAD_PER_DEG

KNOT_MM = 1.4
"""Radius of a knot's pocket."""
KNOT_HOLE_MM = 0.4
"""Radius of the hole that a strand goes through to its knot."""
LEAST_WRAP_RAD = math.radians(12.0)
"""Wrap that a strand keeps before its anchor, at the end of its travel."""
TURN_RAD = math.radians(340.0)
"""Most wrap that one strand's width of groove takes up."""
KNOTS_APART_RAD = math.radians(66.0)
"""Both knots' pockets are at least this far apart about the shaft."""
RIM_MM = 0.7
"""What lips stand out beyond the strands."""
ROOF_MM = 1.1
"""Thickness over the pockets of the horn's screw heads."""
HEAD_ROOM_MM = 0.1
"""Pockets are deeper than the heads by this."""
CENTRE_THREAD_MM = 3.0
"""Least length of the centre screw beyond the horn."""


@dataclass(frozen=True)
class Spool:
    """Lengths [mm] of a spool, and angles [rad] about its axis from +x."""

    pitch: float
    """Radius of a wound strand's core."""
    strand: float
    """Radius of a strand."""
    groove: float
    """Width of a groove: one strand for each turn, and a gap."""
    lip: float
    head_circle: float
    """Radius of the circle of the horn's screws, whose heads drive the spool."""
    head: float
    """Radius of the pockets of these heads."""
    head_depth: float
    """Depth of these pockets."""
    head_proud: float
    """What the heads' undersides stand above the horn, because the screws are no longer than it is thick."""
    bore: float
    """Radius of the centre screw's hole."""
    travel: float
    """Largest turn that a motor makes over the joints' ranges."""
    wrap: float
    """Wrap of each strand in the middle of the travel, up to its anchor."""

    @property
    def root(self) -> float:
        """Radius of the grooves' floor."""
        return self.pitch - self.strand

    @property
    def rim(self) -> float:
        """Radius of the lips."""
        return self.pitch + self.strand + RIM_MM

    @property
    def flange(self) -> float:
        """Radius of the flange on the horn, and the largest of all."""
        return max(self.head_circle + self.head + self.lip, self.rim)

    @property
    def flange_height(self) -> float:
        """Height of the flange, where the flexor's groove begins."""
        return self.head_depth + ROOF_MM

    @property
    def flexor_z(self) -> float:
        """Middle of the flexor's groove."""
        return self.flange_height + self.groove / 2

    @property
    def extensor_z(self) -> float:
        """Middle of the extensor's groove."""
        return self.flexor_z + self.groove + self.lip

    @property
    def height(self) -> float:
        """From the horn to the outer face."""
        return self.extensor_z + self.groove / 2 + self.lip

    @property
    def head_places(self) -> tuple[tuple[float, float], ...]:
        """x, y of the horn's four screws."""
        at = self.head_circle * math.sqrt(0.5)
        return (at, at), (-at, at), (-at, -at), (at, -at)

    @property
    def knot_radius(self) -> float:
        """Radius at which the knots lie."""
        return (self.root + self.bore) / 2

    @property
    def flexor_knot(self) -> float:
        """Angle of the flexor's anchor."""
        return self.wrap

    @property
    def extensor_knot(self) -> float:
        """Angle of the extensor's anchor."""
        return math.pi - self.wrap


def spool_dimensions(spec: Spec) -> Spool:
    """Lengths of the spool that a spec asks for; :class:`MakeError` where its radius is too small."""
    body = lookup("motor_bodies", MotorBody, spec.motors.type)
    screw, centre = (lookup("screws", Screw, s) for s in (body.horn_screw, body.centre_screw))
    settings = spec.print
    strand = lookup("tendons", Tendon, TENDON).diameter_mm / 2
    proud = max(horn_screw_length(body) - body.horn_height_mm, 0.0)
    travel = largest_travel(spec)
    wrap = _wrap(travel)
    turns = math.ceil((wrap + travel / 2) / TURN_RAD)
    spool = Spool(
        pitch=spec.motors.transmission.spool_radius_mm,
        strand=strand,
        groove=turns * 2 * strand + settings.clearance_mm,
        lip=settings.bone_wall_mm + LIP_EXTRA_MM,
        head_circle=body.horn_circle_mm / 2,
        head=(screw.head_diameter_mm + settings.hold_mm) / 2,
        head_depth=proud + screw.head_height_mm + HEAD_ROOM_MM,
        head_proud=proud,
        bore=centre.clearance_hole_mm / 2,
        travel=travel,
        wrap=wrap,
    )
    needs = spool.bore + 2 * (KNOT_MM + settings.bone_wall_mm) + strand
    if spool.pitch < needs - 1e-9:
        raise MakeError(
            f"spool: motors.transmission.spool_radius_mm is {spool.pitch:g} mm, the centre screw "
            f"{centre.size} and the strands' knots need {needs:.2f} mm"
        )
    return spool


def horn_screw_length(body: MotorBody) -> float:
    """Length [mm] of the screws in the horn: the shortest that is sold and goes all through it."""
    return lookup("screws", Screw, body.horn_screw).shortest(body.horn_height_mm)


def centre_screw_length(body: MotorBody, spool: Spool) -> float:
    """Length [mm] of the screw along the shaft that holds spool and horn."""
    least = spool.height + body.horn_height_mm + CENTRE_THREAD_MM
    return lookup("screws", Screw, body.centre_screw).shortest(least)


def largest_travel(spec: Spec) -> float:
    """Largest turn [rad] of any motor over the joints' ranges."""
    joints = TEMPLATES[spec.hand.template].joints
    spans = np.array([np.ptp(spec.hand.joint_limits_deg[joint]) for joint in joints])
    turns = np.abs(finger_transmission(spec.motors.transmission)) @ spans
    return float(turns.max()) * RAD_PER_DEG


def _wrap(travel: float) -> float:
    """Wrap [rad] at mid travel: enough for half the travel, and with the knots apart.

    The knots lie at `wrap` and `pi - wrap`, so `2 wrap - pi` must keep away from whole turns.
    """
    least = travel / 2 + LEAST_WRAP_RAD
    apart = (2 * least - math.pi) % (2 * math.pi)
    if apart < KNOTS_APART_RAD:
        return least + (KNOTS_APART_RAD - apart) / 2
    if apart > 2 * math.pi - KNOTS_APART_RAD:
        return least + (2 * math.pi - apart + KNOTS_APART_RAD) / 2
    return least


def spool_solid(s: Spool) -> Solid:
    """The spool in its frame: flange over the horn, then the flexor's groove, then the extensor's."""
    body = rod((0, 0, 0), (0, 0, s.height), s.root)
    body = body.fuse(rod((0, 0, 0), (0, 0, s.flange_height), s.flange))
    for low in (s.flexor_z + s.groove / 2, s.height - s.lip):
        body = body.fuse(rod((0, 0, low), (0, 0, low + s.lip), s.rim))
    heads = [rod((*at, -1), (*at, s.head_depth), s.head) for at in s.head_places]
    knots = [
        _knot(s, z, angle)
        for z, angle in ((s.flexor_z, s.flexor_knot), (s.extensor_z, s.extensor_knot))
    ]
    bore = rod((0, 0, -1), (0, 0, s.height + 1), s.bore)
    return body.cut(bore, *heads, *knots).clean()


def _knot(s: Spool, z: float, angle: float) -> Solid:
    """A strand's hole from its groove inwards, and a pocket for the knot, open to the outer face."""
    c, sine = math.cos(angle), math.sin(angle)
    knot, far = s.knot_radius, s.rim + 1
    hole = rod((c * knot, sine * knot, z), (c * far, sine * far, z), KNOT_HOLE_MM)
    start = z - KNOT_HOLE_MM
    return hole.fuse(
        rod((c * knot, sine * knot, start), (c * knot, sine * knot, s.height + 1), KNOT_MM)
    )
