"""How long each tendon is from knot to knot: through the hand, its tube and the box, and around its spool."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from fpcad.make.parts.dimensions import Dimensions
from fpcad.make.parts.mounting import Mounting
from fpcad.make.parts.part import Array
from fpcad.make.parts.routing import EXIT_MM, TUBE_SEAT_MM
from fpcad.make.parts.tendon_paths import FingerTendons
from fpcad.make.parts.tube_routes import MOTORS
from fpcad.model.geometry import HandGeometry
from fpcad.model.transmission import finger_transmission

TAIL_MM = 60.0
"""What a knot takes up and hands need to tie it, at each end."""


@dataclass(frozen=True)
class TendonLength:
    """One motor's strand with straight fingers [mm]."""

    strand: str
    in_hand: float
    """From its knot on the pulley to where it leaves the palm."""
    shortest: float
    """The same, least over the joints' ranges."""
    longest: float
    tube: float
    """Length of its whole tube, of which some sits in the palm."""
    in_box: float
    """From the tube's end to the spool, the tensioner in the middle of its way."""
    on_spool: float
    """Around the spool to the other knot."""

    @property
    def total(self) -> float:
        """From knot to knot."""
        in_tube = self.tube - (EXIT_MM - TUBE_SEAT_MM)
        return self.in_hand + in_tube + self.in_box + self.on_spool

    @property
    def to_cut(self) -> float:
        """With what both knots need."""
        return self.total + 2 * TAIL_MM


def tendon_lengths(geometry: HandGeometry, d: Dimensions, mount: Mounting) -> list[TendonLength]:
    """All strands between pulleys and spools, in the order of fingers, motors and their tubes."""
    corners = np.array(list(itertools.product(d.mcp_flex, d.mcp_abd, d.ip_flex)))
    middle = _mid_travel(d, mount)
    found = []
    for finger in geometry.fingers:
        tendons = FingerTendons(d, geometry.T_palm_root[finger])
        at_rest = tendons.motor_strands(np.zeros(3))
        moved = [tendons.motor_strands(joints) for joints in corners]
        for name, length in at_rest.items():
            strand, motor = f"{finger}_{name}", name.split("_")[0]
            lengths = [lengths[name] for lengths in moved]
            slot, flexor = mount.slot(f"{finger}_{motor}"), name.endswith("flexor")
            turned = -middle[MOTORS.index(motor)] * (1 if flexor else -1)
            found.append(
                TendonLength(
                    strand,
                    length,
                    min(lengths),
                    max(lengths),
                    mount.route[strand].length_mm,
                    slot.flexor_straight_mm if flexor else slot.extensor_straight_mm,
                    mount.box.spool.pitch * (mount.box.spool.wrap + turned),
                )
            )
    return found


def _mid_travel(d: Dimensions, mount: Mounting) -> Array:
    """Angles (3,) [rad] of a finger's motors in the middle of their travel; flexors wind up as they grow."""
    ranges = np.array([d.mcp_flex, d.mcp_abd, d.ip_flex])
    A = finger_transmission(mount.spec.motors.transmission)
    return A @ ranges.mean(axis=1)


def strands_in_fingers(geometry: HandGeometry, d: Dimensions) -> float:
    """Length [mm] of a finger's own strands, knots not counted.

    Two run around the output disc and the idler from one input pulley to the other, two from the drum to the IP
    pulley. The dorsal ones are taken to be as long as the palmar ones.
    """
    tendons = FingerTendons(d, geometry.T_palm_root[geometry.fingers[0]])
    across, along = tendons.own_strands()
    return 2 * across + 2 * along
