"""Inertias of real bodies: physically possible, and of the size that their shapes have."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fpcad.check_description.check import Fault
from fpcad.check_description.package import Package
from fpcad.check_description.shapes import hull_of, outside_hull
from fpcad.check_description.urdf import Inertial, Link, Urdf

ROUNDING = 1e-6
"""Share of the largest moment [-] by which an inequality may fail, since numbers are rounded."""
DENSITY_KG_M3 = (10.0, 12_000.0)
"""Mass over the volume of the hull: from hollow plastic to lead."""
SPREAD = (0.1, 10.0)
"""Inertia over that of the hull filled evenly with the same mass [-]."""
SLACK_M, SLACK_SHARE = 1e-4, 0.02
"""How far a centre may lie outside the hull: in metres, and as a share of its size."""


def inertia(_: Package, robot: Urdf) -> Iterator[Fault]:
    """Moving links without mass, and tensors that no body can have.

    A link that is fixed to another may be a point or a mere frame.
    """
    moved = {joint.child for joint in robot.moving()}
    for link in robot.links:
        subject, body, moves = f"link {link.name}", link.inertial, link.name in moved
        if body is None:
            if moves:
                yield Fault(subject, "moves and has no inertial")
        elif body.mass < 0 or (moves and body.mass == 0):
            yield Fault(subject, f"weighs {body.mass:g} kg")
        else:
            yield from (Fault(subject, message) for message in _impossible(body, moves))


def _impossible(body: Inertial, moves: bool) -> Iterator[str]:
    smallest, middle, largest = np.linalg.eigvalsh(body.tensor)
    if smallest < -ROUNDING * largest or (moves and smallest <= 0):
        yield f"its inertia is not positive definite: {smallest:.3g} kg m^2"
    elif largest > (smallest + middle) + ROUNDING * largest:
        yield (
            f"its largest moment {largest:.4g} exceeds the sum of the others, "
            f"{smallest + middle:.4g} kg m^2"
        )


def plausible(_: Package, robot: Urdf) -> Iterator[Fault]:
    """Masses and inertias that do not fit the shapes."""
    for link, body in _with_shapes(robot):
        hull = hull_of(link.visuals or link.collisions)
        density = body.mass / hull.volume
        low, high = DENSITY_KG_M3
        if not low <= density <= high:
            yield Fault(
                f"link {link.name}",
                f"{body.mass:.4g} kg in a hull of {hull.volume * 1e6:.4g} cm^3 is "
                f"{density:.3g} kg/m^3; plausible are {low:g} to {high:g}",
            )
        even = np.trace(hull.moment_inertia) / hull.volume * body.mass
        spread = np.trace(body.tensor) / even
        if not SPREAD[0] <= spread <= SPREAD[1]:
            yield Fault(
                f"link {link.name}",
                f"its inertia is {spread:.3g} times that of its hull filled evenly; plausible are "
                f"{SPREAD[0]:g} to {SPREAD[1]:g}",
            )


def centre(_: Package, robot: Urdf) -> Iterator[Fault]:
    """Centres of mass outside the hull of the link's shapes."""
    for link, body in _with_shapes(robot):
        hull = hull_of((*link.visuals, *link.collisions))
        slack = max(SLACK_M, SLACK_SHARE * float(hull.extents.max()))
        outside = float(outside_hull(hull, body.centre[None])[0])
        if outside > slack:
            yield Fault(
                f"link {link.name}",
                f"its centre of mass is {1e3 * outside:.2f} mm outside the hull",
            )


def _with_shapes(robot: Urdf) -> Iterator[tuple[Link, Inertial]]:
    for link in robot.links:
        body = link.inertial
        if body is not None and body.mass > 0 and (link.visuals or link.collisions):
            yield link, body
