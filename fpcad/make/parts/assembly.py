"""All that a hand is put together from: printed parts, and bought items where they sit."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import numpy as np
import trimesh
from scipy.spatial.transform import Rotation

from fpcad.errors import MakeError
from fpcad.make.mesh import mesh_of
from fpcad.make.parts.bone import distal_bone, proximal_bone
from fpcad.make.parts.bought import BoughtItem, finger_items
from fpcad.make.parts.differential import idler_pulley, input_pulley, ip_drum, mcp_cross
from fpcad.make.parts.dimensions import Dimensions, finger_dimensions
from fpcad.make.parts.flange import flange_solid
from fpcad.make.parts.flange_dimensions import FlangeDimensions
from fpcad.make.parts.materials import cross_material
from fpcad.make.parts.mounting import mounting
from fpcad.make.parts.palm import MOUNT_INSETS_MM, palm_solid
from fpcad.make.parts.palm_pad import NAME as PAD
from fpcad.make.parts.palm_pad import pad_place, pad_solid
from fpcad.make.parts.part import FIXED_LINK, Array, Material, Part, in_place
from fpcad.make.parts.skin import distal_skin, proximal_skin
from fpcad.make.parts.solids import Solid
from fpcad.make.toolchain import modelling
from fpcad.model.geometry import HandGeometry
from fpcad.spec.hardware import Print
from fpcad.spec.schema import Spec

__all__ = ["Assembly", "BoughtItem", "Progress", "make_assembly"]

SKIN_MESH = {"mesh_tolerance_mm": 0.02, "mesh_angle_deg": 5.7}
"""Skins are meshed finer than the rest: their surface is what touches the tool."""

log = logging.getLogger(__name__)

Progress = Callable[[str], None]
"""Told what is being made, in a few words."""


@dataclass(frozen=True)
class Assembly:
    """A whole hand at zero joint angles; URDF link frames place it at any other."""

    parts: tuple[Part, ...]
    bought: tuple[BoughtItem, ...]


def make_assembly(spec: Spec, geometry: HandGeometry, progress: Progress) -> Assembly:
    """Everything of a hand; raises :class:`fpcad.errors.MakeError` with the reason otherwise."""
    d = finger_dimensions(spec, geometry)
    mount = mounting(spec, geometry, d)
    parts = _hand_parts(spec, geometry, d, mount.flange, progress)
    progress("motor box")
    parts += mount.parts()
    return Assembly(tuple(parts), (*finger_items(d, len(geometry.fingers)), *mount.items()))


def _hand_parts(
    spec: Spec, geometry: HandGeometry, d: Dimensions, flange: FlangeDimensions, progress: Progress
) -> list[Part]:
    """Fingers, palm and flange; parts that fingers share are made once."""
    parts = []
    for plan in _plans(geometry, flange, cross_material(spec.print)):
        progress(plan.name)
        solid, mesh = _made(plan, d, spec)
        count = len(plan.places) * (1 if plan.link == FIXED_LINK else len(geometry.fingers))
        parts.append(
            Part(plan.name, plan.link, plan.material, count, solid, mesh, plan.places, plan.T_bed)
        )
    return parts


def _made(plan: _Plan, d: Dimensions, spec: Spec) -> tuple[Solid, trimesh.Trimesh]:
    """A part's solid and mesh by the first of its makers whose result is sound."""
    settings = spec.print.model_copy(update=SKIN_MESH) if plan.material == "skin" else spec.print
    for make in plan.makers[:-1]:
        try:
            return _modelled(plan.name, make, d, settings)
        except MakeError as error:
            log.debug("%s: %s; another inset is tried", plan.name, error)
    return _modelled(plan.name, plan.makers[-1], d, settings)


def _modelled(
    name: str, make: Callable[[Dimensions], Solid], d: Dimensions, settings: Print
) -> tuple[Solid, trimesh.Trimesh]:
    with modelling(name):
        solid = make(d)
        return solid, mesh_of(name, solid, settings)


@dataclass(frozen=True)
class _Plan:
    """How one part is made, where its copies sit on their link, and how it is printed."""

    name: str
    link: str
    material: Material
    makers: tuple[Callable[[Dimensions], Solid], ...]
    """Mostly one; the palm has more, because nearly touching surfaces can break solid modelling."""
    places: tuple[Array, ...] = field(default_factory=in_place)
    T_bed: Array = field(default_factory=lambda: np.eye(4))


def _plans(geometry: HandGeometry, flange: FlangeDimensions, cross: Material) -> list[_Plan]:
    axis_up, on_end = turned("x", 90.0), turned("y", 90.0)
    palms = tuple(partial(palm_solid, geometry, flange, inset=inset) for inset in MOUNT_INSETS_MM)
    both_sides = (np.eye(4), turned("z", 180.0))
    return [
        _Plan("palm", "palm", "endoskeleton", palms, T_bed=turned("x", 180.0)),
        _Plan(
            "flange",
            "palm",
            "endoskeleton",
            (partial(flange_solid, flange, geometry),),
        ),
        *_pad_plans(geometry, flange),
        _Plan("mcp_cross", "mcp", cross, (mcp_cross,), T_bed=on_end),
        _Plan("input_pulley", "mcp", "endoskeleton", (input_pulley,), both_sides, axis_up),
        _Plan("idler_pulley", "mcp", "endoskeleton", (idler_pulley,)),
        _Plan("ip_drum", "mcp", "endoskeleton", (ip_drum,), T_bed=axis_up),
        _Plan("proximal_bone", "proximal", "endoskeleton", (proximal_bone,), T_bed=axis_up),
        _Plan("proximal_skin", "proximal", "skin", (proximal_skin,), T_bed=on_end),
        _Plan("distal_bone", "distal", "endoskeleton", (distal_bone,), T_bed=axis_up),
        _Plan("distal_skin", "distal", "skin", (distal_skin,), T_bed=on_end),
    ]


def _pad_plans(geometry: HandGeometry, flange: FlangeDimensions) -> list[_Plan]:
    """The palm's pad, where there is room for one."""
    place = pad_place(geometry, flange)
    return (
        []
        if place is None
        else [_Plan(PAD, FIXED_LINK, "skin", (partial(pad_solid, geometry, place),))]
    )


def turned(axis: str, degrees: float) -> Array:
    """Pose (4, 4) that only turns, about a coordinate axis."""
    pose = np.eye(4)
    pose[:3, :3] = Rotation.from_euler(axis, degrees, degrees=True).as_matrix()
    return pose
