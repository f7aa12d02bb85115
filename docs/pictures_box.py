"""Draw a spec's motor box for the documents: .venv/bin/python docs/pictures_box.py designs/clay.yaml."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import trimesh

from fpcad.make.documents.stamp import Stamp
from fpcad.make.documents.views import BOUGHT_COLOUR, COLOURS, draw
from fpcad.make.mesh import manifold_of
from fpcad.make.parts.motor_box import box_parts
from fpcad.make.parts.motor_box_dimensions import motor_box_dimensions
from fpcad.make.parts.motor_box_items import box_items
from fpcad.spec.dump import spec_hash
from fpcad.spec.load import load_spec
from fpcad.spec.templates import TEMPLATES

OWN = {"spool": "#7fae6a", "tension_carriage": "#e07350", "motor": "#4a5160"}


def main(file: Path) -> None:
    """Write NAME-motor-box.png, and -cut.png at the plane of one extensor."""
    spec, here = load_spec(file), np.eye(4)
    fingers = len(TEMPLATES[spec.hand.template].fingers)
    stamp = Stamp(spec.name, None, spec_hash(spec))
    box = motor_box_dimensions(spec, fingers)
    pieces = [
        (part.mesh.copy().apply_transform(place), OWN.get(part.name, COLOURS[part.material]))
        for part in box_parts(spec, fingers, here)
        for place in part.places
    ] + [
        (item.mesh.copy().apply_transform(place), OWN.get(item.name, BOUGHT_COLOUR))
        for item in box_items(spec, fingers, here)
        for place in item.places
    ]
    name = Path("docs") / "images" / f"{spec.name}-motor-box"
    draw(pieces, name.with_name(f"{name.name}.png"), (0.5, -1.0, 0.6), stamp)
    x, halves = box.slots[2].extensor_port[0], []
    for mesh, colour in pieces:
        raw = manifold_of(mesh).trim_by_plane((-1.0, 0.0, 0.0), -x).to_mesh64()
        if len(raw.tri_verts):
            half = trimesh.Trimesh(raw.vert_properties[:, :3], raw.tri_verts, process=False)
            halves.append((half, colour))
    draw(halves, name.with_name(f"{name.name}-cut.png"), (1.0, 0.0, 1e-4), stamp)


main(Path(sys.argv[1]))
