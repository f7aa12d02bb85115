"""The palm: the template's primitives, less the room in which the fingers' roots move."""

from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import NDArray

from fpcad.errors import MakeError
from fpcad.make.parts.catalogue import Tube, lookup
from fpcad.make.parts.dimensions import Dimensions
from fpcad.make.parts.flange import palm_seat
from fpcad.make.parts.flange_dimensions import FlangeDimensions
from fpcad.make.parts.palm_pad import pad_place, pad_recess
from fpcad.make.parts.palm_room import below_roof, link_room
from fpcad.make.parts.routing import EXIT_MM, TUBE, TUBE_SEAT_MM, dorsal_angle, strands
from fpcad.make.parts.solids import (
    Solid,
    ball,
    box,
    cleaned,
    palm_primitive,
    placed,
    rod,
    swept_link,
    union,
)
from fpcad.model.geometry import HandGeometry

MOUNT_INSETS_MM = (0.31, 0.47, 0.23)
"""As for the bars, and no multiples of their step: mounts and bars would touch at their tops.

One after the other is tried, until the palm is sound."""
CRUMBS_MM3 = 20.0
"""What may be lost of the palm where cuts leave slivers apart from it."""

PALMAR_MM = 3.0
"""Between its ears the palm begins that far dorsally of the flexion axis."""

INSET_STEP_MM = 0.2
"""Primitives are inset by multiples of this, because surfaces that only touch break solid modelling."""


def palm_solid(
    geometry: HandGeometry, flange: FlangeDimensions, d: Dimensions, inset: float
) -> Solid:
    """The palm in the hand frame H; `inset` [mm] is that of the mounts in their primitives."""
    roots = [geometry.T_palm_root[finger] for finger in geometry.fingers]
    under = below_roof(geometry)
    body = union([*_bars_with_grooves(geometry, d, under), *_mounts(geometry, inset)])
    for root in roots:
        sweeps = placed(_near_link_room(d), root), placed(_neck_room(d), root)
        body = body.cut(*[sweep.intersect(under) for sweep in sweeps])
        body = body.cut(placed(_turning_room(d), root), placed(_axle_hole(d), root))
        body = body.cut(placed(_palmar_room(d, root), root))
        body = body.cut(*[placed(channel, root) for channel in _channels(d, root)])
    body = body.cut(*palm_seat(flange, d.clearance))
    place = pad_place(geometry, flange)
    if place is not None:
        body = body.cut(*pad_recess(geometry, place, d))
    return _largest(cleaned(body))


def _mounts(geometry: HandGeometry, inset: float) -> list[Solid]:
    """The primitives of each finger: what its ears are cut from."""
    own = [shape for shape in geometry.palm if shape.finger is not None]
    return [palm_primitive(shape, inset + n * 0.01) for n, shape in enumerate(own)]


def _largest(body: Solid) -> Solid:
    """The body without the crumbs that cuts leave at rims; a palm in two halves is told instead."""
    pieces = sorted(body.Solids(), key=lambda piece: piece.Volume())
    if sum(piece.Volume() for piece in pieces[:-1]) > CRUMBS_MM3:
        raise MakeError(
            f"palm: the fingers' room cuts it in {len(pieces)} pieces; the second is of "
            f"{pieces[-2].Volume():.0f} mm^3"
        )
    return pieces[-1]


def _channels(d: Dimensions, root: NDArray[np.float64]) -> list[Solid]:
    """Ways of the six strands, and seats of the tubes that they leave the palm in; root's frame."""
    tube = lookup("tubes", Tube, TUBE).outer_mm / 2 + d.mcp.hold
    found = []
    for strand in strands(d, root):
        points = strand.outside()
        found += [rod(a, b, d.channel) for a, b in itertools.pairwise(points)]
        found += [ball(point, d.channel) for point in points[1:-1]]
        last, end = points[-2], points[-1]
        away = (end - last) / np.linalg.norm(end - last)
        found.append(rod(end - (EXIT_MM - TUBE_SEAT_MM) * away, end + 3.0 * away, tube))
    return found


def _bars_with_grooves(geometry: HandGeometry, d: Dimensions, under: Solid) -> list[Solid]:
    """The palm's bars less all that the proximal links pass below the roof.

    What lies in any finger's root sphere stays: it ties that finger's ears to the roof.
    """
    shapes = [shape for shape in geometry.palm if shape.finger is None]
    if not shapes:
        return []
    bars = union(
        [palm_primitive(shape, n * INSET_STEP_MM) for n, shape in enumerate(shapes, start=1)]
    )
    roots = [geometry.T_palm_root[finger] for finger in geometry.fingers]
    kept = [ball(root[:3, 3], d.root - 2 * d.clearance) for root in roots]
    for root in roots:
        groove = placed(link_room(d, d.mcp_abd, d.proximal_length + d.skin_outer), root)
        bars = bars.cut(groove.intersect(under).cut(*kept))
    return [bars]


def _near_link_room(d: Dimensions) -> Solid:
    """What the link passes in pure flexion close to its root: it cuts only its neighbours' ears."""
    room = link_room(d, (0.0, 0.0), 2 * d.root)
    return room.cut(ball((0, 0, 0), d.root - d.clearance / 2))


def _neck_room(d: Dimensions) -> Solid:
    """What the proximal bone's neck passes between the palm's ears."""
    reach, high = (0.0, d.shaft_start + d.clearance), d.mcp.arm_outer + d.clearance
    return swept_link(reach, d.neck_room + d.clearance, high, d.mcp_flex, d.mcp_abd)


def _turning_room(d: Dimensions) -> Solid:
    """What cross, pulleys and discs pass between the ears."""
    m = d.mcp
    return rod((0, -m.ear_inner, 0), (0, m.ear_inner, 0), m.cavity)


def _palmar_room(d: Dimensions, root: NDArray[np.float64]) -> Solid:
    """All between the ears on the palmar side, where only a thin shell would be left."""
    far, half = d.root + 4.0, d.mcp.ear_inner
    room = box((-far, -half, -far), (far, half, PALMAR_MM))
    return room.rotate((0, 0, 0), (0, 1, 0), math.degrees(dorsal_angle(root)))


def _axle_hole(d: Dimensions) -> Solid:
    """The flexion axle's hole, long enough to push the axle in from the side."""
    far = 2.5 * d.root
    return rod((0, -far, 0), (0, far, 0), d.mcp.axle + d.mcp.hold)
