"""One finger to print and try before the whole hand: its parts, and a mount cut from the palm."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import trimesh

from fpcad.errors import MakeError, SpecError
from fpcad.make.bom import bill_of_materials, bom_csv
from fpcad.make.documents.print_ready import write_print_files
from fpcad.make.documents.stamp import Stamp
from fpcad.make.gates.bodies import union
from fpcad.make.gates.finding import refuse_errors
from fpcad.make.gates.mesh import check_mesh
from fpcad.make.mesh import manifold_of
from fpcad.make.parts.assembly import Assembly
from fpcad.make.parts.part import STILL_LINKS, Part
from fpcad.model.geometry import HandGeometry
from fpcad.spec.schema import Spec

MOUNT = "finger_mount"
PALM = "palm"
AROUND_MM = 14.0
"""The mount keeps so much of the palm to each side of the finger's root."""
BLOCK_MM = (24.0, 24.0, 20.0)
"""A block on the mount's back, for a vice."""
SUNK_MM = 4.0


def write_finger(
    spec: Spec, assembly: Assembly, geometry: HandGeometry, finger: str, folder: Path, stamp: Stamp
) -> list[Path]:
    """Write the print files and the bill of one finger and its mount to `folder`."""
    if finger not in geometry.fingers:
        raise SpecError(f'no finger "{finger}"; allowed: {", ".join(geometry.fingers)}')
    fingers = len(geometry.fingers)
    own = [
        replace(p, count=p.count // fingers) for p in assembly.parts if p.link not in STILL_LINKS
    ]
    bought = [
        replace(i, count=i.count // fingers) for i in assembly.bought if i.link not in STILL_LINKS
    ]
    palm = next((part for part in assembly.parts if part.name == PALM), None)
    if palm is None:
        raise MakeError(f"{finger}: there is no palm to cut a mount from")
    alone = Assembly((*own, _mount(palm, geometry, finger)), tuple(bought))
    files = write_print_files(alone.parts, spec.print, folder, stamp)
    bill = bill_of_materials(spec, alone, 1, {})
    return [*files, stamp.write(folder / "bom.csv", bom_csv(bill))]


def _mount(palm: Part, geometry: HandGeometry, finger: str) -> Part:
    """The palm's piece around a finger's root, with a block to hold it by."""
    root = geometry.T_palm_root[finger][:3, 3]
    low, high = palm.mesh.bounds
    height = float(high[2] - low[2]) + 2.0
    near = trimesh.creation.box((2 * AROUND_MM, 2 * AROUND_MM, height))
    near.apply_translation((root[0], root[1], (low[2] + high[2]) / 2))
    piece = manifold_of(palm.mesh) ^ manifold_of(near)
    middle = np.array(piece.bounding_box()).reshape(2, 3).mean(axis=0)
    block = trimesh.creation.box(BLOCK_MM)
    top = float(piece.bounding_box()[5])
    block.apply_translation((middle[0], middle[1], top + BLOCK_MM[2] / 2 - SUNK_MM))
    bodies = union([piece, manifold_of(block)]).decompose()
    whole = max(bodies, key=lambda body: body.volume()).to_mesh64()
    mesh = trimesh.Trimesh(whole.vert_properties[:, :3], whole.tri_verts, process=False)
    refuse_errors(check_mesh(MOUNT, mesh))
    return replace(palm, name=MOUNT, count=1, mesh=mesh, T_bed_part=np.eye(4))
