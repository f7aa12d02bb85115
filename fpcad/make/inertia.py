"""Mass, centre and inertia of bodies made of several materials, in SI units."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
import trimesh
from numpy.typing import NDArray

from fpcad.make.parts.assembly import Assembly
from fpcad.units import M_PER_MM

Array = NDArray[np.float64]

KG_PER_MM3_AT_1_G_CM3 = 1e-6


@dataclass(frozen=True)
class Inertia:
    """Inertial properties of a rigid body in the frame of its link."""

    mass_kg: float
    centre_m: Array  # (3,)
    tensor_kgm2: Array  # (3, 3) about the centre, axes of the link's frame


def link_inertia(assembly: Assembly, link: str, density: Mapping[str, float]) -> Inertia:
    """Inertia of one link from all that is printed and bought for it, each copy where it sits.

    `density` [g/cm^3] by printed material. A bought item counts with the catalogue's mass, spread
    evenly over its envelope.
    """
    bodies = [
        (part.mesh.copy().apply_transform(T), density[part.material])
        for part in assembly.parts
        if part.link == link
        for T in part.places
    ]
    bodies += [
        (item.mesh.copy().apply_transform(T), item.mass_g * 1e3 / item.mesh.volume)
        for item in assembly.bought
        if item.link == link
        for T in item.places
    ]
    return inertia_of(bodies)


def inertia_of(bodies: Iterable[tuple[trimesh.Trimesh, float]]) -> Inertia:
    """Combined inertia of meshes [mm], each with its density [g/cm^3], fixed to one another."""
    masses, centres, tensors = [], [], []
    for mesh, density in bodies:
        kg_per_mm3 = density * KG_PER_MM3_AT_1_G_CM3
        properties = mesh.mass_properties
        masses.append(properties.volume * kg_per_mm3)
        centres.append(np.asarray(properties.center_mass) * M_PER_MM)
        tensors.append(np.asarray(properties.inertia) * kg_per_mm3 * M_PER_MM**2)
    mass = float(np.sum(masses))
    centre = np.average(centres, axis=0, weights=masses)
    tensor = np.zeros((3, 3))
    for m, c, own in zip(masses, centres, tensors, strict=True):
        offset = c - centre
        tensor += own + m * (offset @ offset * np.eye(3) - np.outer(offset, offset))
    return Inertia(mass, centre, (tensor + tensor.T) / 2)
