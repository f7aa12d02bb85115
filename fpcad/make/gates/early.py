"""Gate before any solid modelling: what can be told from a design's numbers alone."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from fpcad.errors import MakeError
from fpcad.make.gates.postures import rest_joints
from fpcad.make.grip import ContactLink, link_axis, segment_distance
from fpcad.make.parts.dimensions import finger_dimensions
from fpcad.make.parts.mounting import flange_and_box
from fpcad.model.geometry import HandGeometry
from fpcad.spec.schema import Spec

LINKS = ("proximal", "distal")


def check_early(spec: Spec, geometry: HandGeometry) -> None:
    """Raise :class:`MakeError` with the reason why a design cannot be made, if one shows already."""
    flange_and_box(spec, geometry, finger_dimensions(spec, geometry))
    _check_rest(spec, geometry)


def _check_rest(spec: Spec, geometry: HandGeometry) -> None:
    """Fingers at rest keep apart."""
    joints = rest_joints(spec.hand, geometry).reshape(1, -1)
    links = [ContactLink(finger, link) for finger in geometry.fingers for link in LINKS]
    axes = {link: link_axis(geometry, link, joints) for link in links}
    reach = 2 * (geometry.radius_mm + spec.print.skin_oversize_mm)
    for a, b in combinations(links, 2):
        if a.finger != b.finger:
            apart = float(np.squeeze(segment_distance(*axes[a], *axes[b]))) - reach
            if apart < 0:
                raise MakeError(
                    f"{a.finger} {a.link} and {b.finger} {b.link} overlap by {-apart:.1f} mm "
                    "at rest; hand.rest_posture_deg decides"
                )
