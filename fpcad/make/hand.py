"""From a design to the folder that is printed, bought, simulated and driven."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from fpcad.make.bom import bill_of_materials, bom_csv
from fpcad.make.description import LinkBody, describe, write_description
from fpcad.make.documents.extras import extra_parts
from fpcad.make.documents.guide import write_guide
from fpcad.make.documents.inventory import write_inventory
from fpcad.make.documents.print_ready import write_print_files
from fpcad.make.documents.stamp import Stamp
from fpcad.make.documents.stand_file import write_stand
from fpcad.make.documents.step_files import assembly_step, part_step
from fpcad.make.gates.all_gates import pass_gates
from fpcad.make.gates.finding import Severity
from fpcad.make.gates.table import FILE as CHECKS
from fpcad.make.gates.table import findings_csv
from fpcad.make.inertia import link_inertia
from fpcad.make.loads.check import load_findings
from fpcad.make.loads.hand import hand_loads
from fpcad.make.loads.table import FILE as LOADS
from fpcad.make.loads.table import loads_csv
from fpcad.make.mesh import in_metres, stl_bytes
from fpcad.make.parts.assembly import Assembly, Progress, make_assembly
from fpcad.make.parts.dimensions import finger_dimensions
from fpcad.make.parts.materials import densities
from fpcad.make.parts.mounting import mounting
from fpcad.make.parts.tendon_lengths import pieces_to_cut
from fpcad.make.stand.gates import GATE as JIG_GATE
from fpcad.make.stand.stand import Stand, make_stand
from fpcad.make.stand.steps import stand_rows
from fpcad.make.trajectory import Trajectory
from fpcad.make.transmission_file import transmission_yaml
from fpcad.model.geometry import HandGeometry
from fpcad.spec.dump import spec_hash
from fpcad.spec.schema import Spec

ASSEMBLY_STEP = "assembly.step"
log = logging.getLogger(__name__)

VISUAL_FOLDER = Path("meshes") / "visual"
"""Visual meshes [m], relative to the `hand` folder."""


def make_hand(
    spec: Spec,
    geometry: HandGeometry,
    out: Path,
    progress: Progress = log.debug,
    trajectories: Mapping[str, Trajectory] = MappingProxyType({}),
    candidate: int | None = None,
) -> list[Path]:
    """Make a hand's parts and description and write them under `out`, a build's folder.

    `progress` is told each step in a few words; the description's postures are the first ones of
    the trajectories, by pose. Returns the files written. Raises
    :class:`fpcad.errors.MakeError` naming the part that cannot be made.
    """
    stamp = Stamp(spec.name, candidate, spec_hash(spec))
    assembly = make_assembly(spec, geometry, progress)
    findings = pass_gates(spec, assembly, geometry, trajectories, progress)
    progress("loads")
    loads = hand_loads(spec, assembly, geometry, trajectories)
    findings += load_findings(loads)
    for finding in findings:
        if finding.severity is Severity.WARNING:
            log.info("%s", finding)
    progress("files")
    parts, folder = assembly.parts, out / "parts"
    stand = _stand(spec, geometry, assembly, trajectories, progress)
    findings += stand.findings if stand else ()
    files = write_parts(spec, assembly, geometry, folder, stamp, stand)
    files.append(stamp.write(folder / CHECKS, findings_csv(findings)))
    files.append(stamp.write(folder / LOADS, loads_csv(loads)))
    files += [
        stamp.write(out / "hand" / VISUAL_FOLDER / f"{p.name}.stl", stl_bytes(in_metres(p.on_link)))
        for p in parts
    ]
    robot = describe(spec, geometry, link_bodies(spec, assembly), trajectories)
    files += write_description(robot, trajectories, out / "hand", stamp)
    files.append(stamp.write(out / "hand" / "transmission.yaml", transmission_yaml(spec, geometry)))
    return files


def write_parts(
    spec: Spec,
    assembly: Assembly,
    geometry: HandGeometry,
    folder: Path,
    stamp: Stamp,
    stand: Stand | None = None,
) -> list[Path]:
    """Write what is printed and bought: meshes, solids, print files, list and bill."""
    files, helpers = [], stand.parts if stand else ()
    for part in helpers:
        solid = part_step(part.name, part.solid)
        files.append(stamp.write(folder / "step" / f"{part.name}.step", solid))
    files += write_print_files(helpers, spec.print, folder, stamp)
    if stand:
        files.append(write_stand(stand, spec.print, folder, stamp))
    for part in assembly.parts:
        mesh = stl_bytes(part.mesh)
        files.append(stamp.write(folder / part.material / f"{part.name}.stl", mesh))
        solid = part_step(part.name, part.solid)
        files.append(stamp.write(folder / "step" / f"{part.name}.step", solid))
    together = assembly_step(assembly, geometry, stamp.name)
    files.append(stamp.write(folder / "step" / ASSEMBLY_STEP, together))
    files += write_print_files(assembly.parts, spec.print, folder, stamp)
    files += write_print_files(extra_parts(spec), spec.print, folder, stamp)
    files += write_inventory(assembly, folder, stamp)
    files += write_guide(spec, assembly, geometry, folder, stamp, stand)
    everything = Assembly((*assembly.parts, *helpers), assembly.bought)
    tendons = pieces_to_cut(spec, geometry)
    bill = bill_of_materials(spec, everything, len(geometry.fingers), {}, tendons)
    bill += stand_rows(spec) if stand else []
    return [*files, stamp.write(folder / "bom.csv", bom_csv(bill))]


def _stand(
    spec: Spec,
    geometry: HandGeometry,
    assembly: Assembly,
    trajectories: Mapping[str, Trajectory],
    progress: Progress,
) -> Stand | None:
    """The bench stand with its jigs, where there are poses to hold a tool at."""
    if not trajectories:
        return None
    progress("bench stand")
    base = mounting(spec, geometry, finger_dimensions(spec, geometry)).T_palm_base
    stand = make_stand(spec, geometry, assembly, base, trajectories)
    for finding in stand.findings:
        if finding.severity is Severity.WARNING and finding.gate == JIG_GATE:
            log.info("%s", finding)
    return stand


def link_bodies(spec: Spec, assembly: Assembly) -> dict[str, LinkBody]:
    """Inertia and visuals of each link, from the parts and bought items that it is made of."""
    density = densities(spec.print)
    bodies = {}
    for link in dict.fromkeys(part.link for part in assembly.parts):
        own = [part for part in assembly.parts if part.link == link]
        bodies[link] = LinkBody(
            link_inertia(assembly, link, density),
            tuple((part.name, part.material) for part in own),
        )
    return bodies
