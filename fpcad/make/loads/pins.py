"""Bearings and pins of one finger: what they carry, how they bend, how hard they push on what holds them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.make.loads.finger import FingerForces, hub_places
from fpcad.make.loads.supports import X, Y, Z, beam_moment, on_axis
from fpcad.make.parts.catalogue import Pin, lookup
from fpcad.make.parts.dimensions import Dimensions
from fpcad.make.parts.materials import bone_strength, cross_strength
from fpcad.make.parts.mcp_dimensions import AXLE, PIVOT
from fpcad.spec.hardware import Print

Array = NDArray[np.float64]

RADIAL, AXIAL = 0.6, 0.5
"""Factors of the static equivalent load of a deep groove ball bearing, ISO 76."""


@dataclass(frozen=True)
class Borne:
    """What one item bears in K states."""

    what: str
    """`bearing`, `pin pressure` or `pin bending`."""
    where: str
    value: Array
    """(K,)"""
    limit: float
    unit: str


def finger_pins(d: Dimensions, forces: FingerForces, settings: Print) -> list[Borne]:
    """Everything that turns or sits on pins in a finger."""
    bone, cross = bone_strength(settings).pressure_mpa, cross_strength(settings).pressure_mpa

    def pressure(where: str, value: Array, allowed: float = bone) -> Borne:
        return Borne("pin pressure", where, value, allowed, "MPa")

    k, m = d.knuckle, d.mcp
    prong = k.prong_outer - k.prong_inner
    clevis = _larger(prong_forces(d, forces))
    low, high = hub_places(d)
    found = [
        _bearing(d, forces),
        pressure("IP pin in the clevis", clevis / (k.bearing.bore_mm * prong)),
        _bending("IP pin", f"D{k.bearing.bore_mm:g}", ip_pin_moment(d, forces)),
        pressure("palmar pin in the output pulley", _palmar_hub(d, forces)),
        pressure("dorsal pin in the arm", _dorsal_hub(d, forces)),
        *(
            pressure(f"{name} pin in the cross", bridge_pressure(d, force, arm), cross)
            for name, force, arm in (
                ("palmar", across(forces.hubs[:, 0], Z), -low),
                ("dorsal", *_dorsal_pin(d, forces, high)),
            )
        ),
        _bending("abduction pins", PIVOT, pivot_moment(d, forces)),
        pressure("axle in the cross", _cheeks(d, forces), cross),
        pressure("axle in the palm", _larger(forces.ears) / (2 * m.axle * m.axle_seat)),
        _bending("axle", AXLE, beam_moment(forces.axle_places, forces.axle_loads)),
    ]
    return found


def prong_forces(d: Dimensions, forces: FingerForces) -> Array:
    """(K, 2, 3) on the clevis's prongs from the pin, at -y and +y, in the proximal frame.

    Sideways the tongue leans on one prong.
    """
    middle = (d.knuckle.prong_inner + d.knuckle.prong_outer) / 2
    found = on_axis(-forces.ip_force, -forces.ip_moment, Y, (-middle, middle))
    sideways = -forces.ip_force[:, 1]
    found[:, 0, 1], found[:, 1, 1] = np.minimum(sideways, 0.0), np.maximum(sideways, 0.0)
    return found


def bearing_forces(d: Dimensions, forces: FingerForces) -> Array:
    """(K, 2, 3) on the distal bone from its two bearings, across the IP axis."""
    middle = d.knuckle.bearing_inner + d.knuckle.bearing.width_mm / 2
    return on_axis(forces.ip_force, forces.ip_moment, Y, (-middle, middle))


def ip_pin_moment(d: Dimensions, forces: FingerForces) -> Array:
    """Largest bending moment (K,) [N mm] of the IP pin between prongs, loaded by the bearings."""
    prong = (d.knuckle.prong_inner + d.knuckle.prong_outer) / 2
    bearing = d.knuckle.bearing_inner + d.knuckle.bearing.width_mm / 2
    loads = np.concatenate([-bearing_forces(d, forces), -prong_forces(d, forces)], axis=1)
    loads[:, :, 1] = 0.0
    return beam_moment(np.array([-bearing, bearing, -prong, prong]), loads)


def pivot_moment(d: Dimensions, forces: FingerForces) -> Array:
    """Larger bending moment (K,) [N mm] of the two abduction pins, where they leave the bridges."""
    low, high = hub_places(d)
    palmar = across(forces.hubs[:, 0], Z) * (-low - d.mcp.bridge_outer)
    dorsal = -forces.hubs[:, 1] * (high - d.mcp.bridge_outer)
    dorsal = dorsal + forces.idler * (d.mcp.input_radius - d.mcp.bridge_outer)
    return np.maximum(palmar, across(dorsal, Z))


def bridge_pressure(d: Dimensions, force: Array, arm_mm: Array | float) -> Array:
    """Largest pressure (K,) [MPa] of a rigid pin in a bridge, for a force at a height [mm].

    The pin's seat presses linearly: F / (d l) by the force, and 6 F e / (d l^2) by its lever e.
    """
    inner, outer = d.mcp.bridge_inner, d.mcp.bridge_outer
    length, lever = outer - inner, np.asarray(arm_mm) - (inner + outer) / 2
    return force / (2 * d.mcp.pivot * length) * (1 + 6 * lever / length)


def bending_mpa(moment_nmm: Array, diameter_mm: float) -> Array:
    """Bending stress [MPa] of a round bar: 32 M / (pi d^3)."""
    return 32 * moment_nmm / (math.pi * diameter_mm**3)


def _bearing(d: Dimensions, forces: FingerForces) -> Borne:
    """The more loaded of both bearings; sideways one takes it all. ISO 76: P0 = 0.6 Fr + 0.5 Fa, or Fr."""
    radial = _larger(bearing_forces(d, forces))
    equivalent = np.maximum(radial, RADIAL * radial + AXIAL * np.abs(forces.ip_force[:, 1]))
    row = d.knuckle.bearing
    return Borne("bearing", f"IP {row.kind} {row.size}", equivalent, row.static_load_n, "N")


def _bending(name: str, size: str, moment: Array) -> Borne:
    pin = lookup("pins", Pin, size)
    stress = bending_mpa(moment, pin.diameter_mm)
    return Borne("pin bending", f"{name} {size}", stress, pin.bending_mpa, "MPa")


def _palmar_hub(d: Dimensions, forces: FingerForces) -> Array:
    m = d.mcp
    return across(forces.hubs[:, 0], Z) / (2 * m.pivot * (m.pivot_outer - m.disc_inner))


def _dorsal_hub(d: Dimensions, forces: FingerForces) -> Array:
    m = d.mcp
    return across(forces.hubs[:, 1], Z) / (2 * m.pivot * (m.pivot_outer - m.arm_inner))


def _dorsal_pin(d: Dimensions, forces: FingerForces, high: float) -> tuple[Array, Array]:
    """Force on the dorsal pin (K,) and the height at which it acts: arm and idler together."""
    arm, idler = -forces.hubs[:, 1], forces.idler
    force = across(arm + idler, Z)
    moment = across(arm * high + idler * d.mcp.input_radius, Z)
    return force, moment / np.maximum(force, 1e-9)


def _cheeks(d: Dimensions, forces: FingerForces) -> Array:
    m = d.mcp
    return _larger(forces.cheeks) / (2 * m.axle * (m.cheek_outer - m.cheek_inner))


def _larger(forces: Array) -> Array:
    """The larger of two forces (K, 2, 3) across the y axis, (K,)."""
    return across(forces, Y).max(axis=1)


def across(forces: Array, axis: int) -> Array:
    """Magnitudes (...,) of forces (..., 3) across an axis."""
    kept = [k for k in (X, Y, Z) if k != axis]
    return np.linalg.norm(forces[..., kept], axis=-1)
