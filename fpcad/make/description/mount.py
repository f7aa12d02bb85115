"""Flange and motor box as collision shapes of the palm."""

from __future__ import annotations

import numpy as np

from fpcad.make.description.shapes import Array, Cuboid, Cylinder, Shape
from fpcad.make.parts.dimensions import finger_dimensions
from fpcad.make.parts.flange_dimensions import PAD_MM, STEM_MM, FlangeDimensions
from fpcad.make.parts.mounting import mounting
from fpcad.model.geometry import HandGeometry
from fpcad.spec.schema import Spec
from fpcad.units import M_PER_MM


def mount_shapes(spec: Spec, geometry: HandGeometry) -> list[Shape]:
    """Foot, stem and disc, and the box where it sits on the flange; tubes give way and have none.

    The cone under the disc counts to the disc from half of its height on.
    """
    mount = mounting(spec, geometry, finger_dimensions(spec, geometry))
    f = mount.flange
    under = f.stem - f.flange.disc_mm
    found = [
        _block("flange_foot", f.T_palm_foot, *_foot(f)),
        _round("flange_stem", f, 0.0, under, STEM_MM),
        _round("flange_disc", f, (f.cone_start + under) / 2, f.stem, f.flange.outer_mm / 2),
    ]
    if spec.mount.box:
        x, y, z = mount.box.size
        corner = np.array([x / 2, y / 2, 0.0])
        found.append(_block("motor_box", mount.tubes.T_palm_box, -corner, corner + _up(z)))
    return found


def _foot(f: FlangeDimensions) -> tuple[Array, Array]:
    """Corners [mm] of the foot with the heads of its screws."""
    top = PAD_MM + f.screw.head_height_mm
    half = np.array([f.half_length, f.half_width, 0.0])
    return -half - _up(f.skirt), half + _up(top)


def _up(z: float) -> Array:
    """A point (3,) on the axis."""
    return np.array([0.0, 0.0, z])


def _round(name: str, f: FlangeDimensions, low: float, high: float, radius: float) -> Cylinder:
    """A cylinder [mm] about the flange's axis, between two heights above its seat."""
    start, end = (
        (f.T_palm_foot @ np.array([0.0, 0.0, z, 1.0]))[:3] * M_PER_MM for z in (low, high)
    )
    return Cylinder(name, start, end, radius * M_PER_MM)


def _block(name: str, T_palm: Array, low: Array, high: Array) -> Cuboid:
    """A box [mm] between two corners in a frame of the palm."""
    middle = np.eye(4)
    middle[:3, 3] = (low + high) / 2
    pose = T_palm @ middle
    pose[:3, 3] *= M_PER_MM
    return Cuboid(name, pose, (high - low) * M_PER_MM)
