"""From a design to the folder that is printed, bought, simulated and driven."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

import trimesh

from fpcad.make.bom import bill_of_materials, bom_csv
from fpcad.make.description import LinkBody, describe, write_description
from fpcad.make.inertia import inertia_of
from fpcad.make.mesh import check_apart, in_metres, stl_bytes
from fpcad.make.parts.dimensions import finger_dimensions
from fpcad.make.parts.assembly import Progress, make_parts
from fpcad.make.parts.part import Part
from fpcad.make.parts.step import step_bytes
from fpcad.make.reach import flexion_reach
from fpcad.make.trajectory import Trajectory
from fpcad.make.transmission_file import transmission_yaml
from fpcad.model.geometry import HandGeometry
from fpcad.spec.catalogue import motor
from fpcad.spec.schema import Spec
from fpcad.store import write_whole
from fpcad.units import DEG_PER_RAD, RAD_PER_DEG

log = logging.getLogger(__name__)

VISUAL_FOLDER = Path("meshes") / "visual"
"""Visual meshes [m], relative to the `hand` folder."""


def make_hand(
    spec: Spec,
    geometry: HandGeometry,
    out: Path,
    progress: Progress = log.debug,
    trajectories: Mapping[str, Trajectory] = MappingProxyType({}),
) -> list[Path]:
    """Make a hand's parts and description and write them under `out`, a build's folder.

    `progress` is told each step in a few words; the description's postures are the first ones of
    the trajectories, by pose. Returns the files written. Raises
    :class:`fpcad.errors.MakeError` naming the part that cannot be made.
    """
    row = motor(spec.motors.type)
    parts = make_parts(spec, geometry, progress)
    progress("interference")
    check_apart(rest_pairs(parts, geometry))
    _warn_of_stops(spec, parts, geometry)
    progress("files")
    files = _part_files(parts, out / "parts")
    dimensions = finger_dimensions(spec, geometry)
    bill = bill_of_materials(spec, dimensions, parts, len(geometry.fingers), row.mass_g)
    files.append(write_whole(out / "parts" / "bom.csv", bom_csv(bill)))
    files += [
        write_whole(out / "hand" / VISUAL_FOLDER / f"{p.name}.stl", stl_bytes(in_metres(p.mesh)))
        for p in parts
    ]
    robot = describe(spec, geometry, link_bodies(spec, parts), trajectories)
    files += write_description(robot, trajectories, out / "hand")
    files.append(write_whole(out / "hand" / "transmission.yaml", transmission_yaml(spec)))
    return files


def _warn_of_stops(spec: Spec, parts: Sequence[Part], geometry: HandGeometry) -> None:
    low, high = spec.hand.joint_limits_deg["mcp_flex"]
    reach = flexion_reach(parts, geometry, (low * RAD_PER_DEG, high * RAD_PER_DEG))
    for finger, (free_low, free_high) in reach.items():
        free = free_low * DEG_PER_RAD, free_high * DEG_PER_RAD
        if free[0] > low + 1e-9 or free[1] < high - 1e-9:
            log.warning(
                "%s: the palm stops MCP flexion near [%.0f, %.0f] deg; the spec allows [%g, %g]",
                *(finger, *free, low, high),
            )


def _part_files(parts: Sequence[Part], folder: Path) -> list[Path]:
    stls = [
        write_whole(folder / part.material / f"{part.name}.stl", stl_bytes(part.mesh))
        for part in parts
    ]
    steps = [
        write_whole(folder / "step" / f"{part.name}.step", step_bytes(part.name, part.solid))
        for part in parts
    ]
    return stls + steps


def link_bodies(spec: Spec, parts: Sequence[Part]) -> dict[str, LinkBody]:
    """Inertia and visuals of each link, from the parts that it is made of."""
    density = {
        "endoskeleton": spec.print.bone_density_g_cm3,
        "skin": spec.print.skin_density_g_cm3,
    }
    bodies = {}
    for link in dict.fromkeys(part.link for part in parts):
        own = [part for part in parts if part.link == link]
        bodies[link] = LinkBody(
            inertia_of((part.mesh, density[part.material]) for part in own),
            tuple((part.name, part.material) for part in own),
        )
    return bodies


def rest_pairs(
    parts: Sequence[Part], geometry: HandGeometry
) -> Iterator[tuple[str, trimesh.Trimesh, str, trimesh.Trimesh]]:
    """Pairs of parts that must not meet when a finger is straight: its own, and each with the palm.

    Straight fingers of one hand may cross each other (thumb and middle of a short palm), so pairs
    of different fingers are no matter of the parts but of the posture.
    """
    meshes = {part.name: part.mesh for part in parts}
    links = {part.name: part.link for part in parts}
    palm = meshes.pop("palm")
    straight = {
        name: mesh.copy().apply_translation(
            [geometry.proximal_length_mm if links[name] == "distal" else 0.0, 0.0, 0.0]
        )
        for name, mesh in meshes.items()
    }
    names = list(straight)
    for i, a in enumerate(names):
        for b in names[i + 1 :]:
            yield a, straight[a], b, straight[b]
    for finger in geometry.fingers:
        for name, mesh in straight.items():
            moved = mesh.copy().apply_transform(geometry.T_palm_root[finger])
            yield "palm", palm, f"{finger} {name}", moved
