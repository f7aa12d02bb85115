"""What parts are of: how heavy, how strong, and what people are told to make them from."""

from __future__ import annotations

from dataclasses import dataclass

from fpcad.make.parts.catalogue import Metal, lookup
from fpcad.make.parts.part import Material
from fpcad.spec.hardware import RIGID, Print


@dataclass(frozen=True)
class Matter:
    """One material of a hand."""

    name: str
    """For people."""
    density_g_cm3: float


@dataclass(frozen=True)
class Strength:
    """What a rigid material may bear [MPa], the safety factor taken off."""

    stress_mpa: float
    pressure_mpa: float
    """Under a pin."""


def matters(settings: Print) -> dict[Material, Matter]:
    """Every material of a hand that is made with these settings."""
    found: dict[Material, Matter] = {
        "endoskeleton": Matter("rigid (PLA or the like)", settings.bone_density_g_cm3),
        "skin": Matter("flexible (TPE)", settings.skin_density_g_cm3),
    }
    if settings.cross_material != RIGID:
        row = lookup("metals", Metal, settings.cross_material)
        found["metal"] = Matter(row.size, row.density_g_cm3)
    return found


def densities(settings: Print) -> dict[str, float]:
    """Density [g/cm^3] of each material."""
    return {material: matter.density_g_cm3 for material, matter in matters(settings).items()}


def cross_material(settings: Print) -> Material:
    """What the MCP crosses are of."""
    return "endoskeleton" if settings.cross_material == RIGID else "metal"


def bone_strength(settings: Print) -> Strength:
    """Of printed bones."""
    factor = settings.safety_factor
    return Strength(settings.bone_strength_mpa / factor, settings.bone_bearing_mpa / factor)


def cross_strength(settings: Print) -> Strength:
    """Of the MCP crosses; a metal yields under a pin no sooner than in tension."""
    if settings.cross_material == RIGID:
        return bone_strength(settings)
    allowed = lookup("metals", Metal, settings.cross_material).yield_mpa / settings.safety_factor
    return Strength(allowed, allowed)
