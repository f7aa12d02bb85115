"""From a design to the folder that is printed, bought, simulated and driven."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

from fpcad.make.bom import bill_of_materials, bom_csv
from fpcad.make.description import LinkBody, describe, write_description
from fpcad.make.gates.all_gates import pass_gates
from fpcad.make.gates.finding import Severity
from fpcad.make.gates.table import FILE as CHECKS
from fpcad.make.gates.table import findings_csv
from fpcad.make.inertia import inertia_of
from fpcad.make.mesh import in_metres, stl_bytes
from fpcad.make.parts.assembly import Progress, make_assembly
from fpcad.make.parts.dimensions import finger_dimensions
from fpcad.make.parts.part import Part
from fpcad.make.parts.step import step_bytes
from fpcad.make.trajectory import Trajectory
from fpcad.make.transmission_file import transmission_yaml
from fpcad.model.geometry import HandGeometry
from fpcad.spec.catalogue import motor
from fpcad.spec.schema import Spec
from fpcad.store import write_whole

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
    assembly = make_assembly(spec, geometry, progress)
    parts, row = assembly.parts, motor(spec.motors.type)
    findings = pass_gates(spec, assembly, geometry, trajectories, progress)
    for finding in findings:
        if finding.severity is Severity.WARNING:
            log.info("%s", finding)
    progress("files")
    files = _part_files(parts, out / "parts")
    files.append(write_whole(out / "parts" / CHECKS, findings_csv(findings)))
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
