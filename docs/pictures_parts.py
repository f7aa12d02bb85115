"""Draw a build's parts for the documents: .venv/bin/python docs/pictures_parts.py build/clay."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from fpcad.make.documents.inventory import read_inventory
from fpcad.make.documents.print_ready import on_bed
from fpcad.make.documents.stamp import Stamp
from fpcad.make.documents.views import COLOURS, cut_open, draw, finger_pieces, hand_pieces
from fpcad.make.gates.meetings import tool_mesh
from fpcad.make.gates.postures import hand_postures, rest_joints
from fpcad.make.parts.dimensions import finger_dimensions
from fpcad.make.parts.mounting import mounting
from fpcad.make.stand.stand import make_stand
from fpcad.make.stand.views import stand_pieces
from fpcad.make.trajectory_file import read_trajectory
from fpcad.pipeline.finished import finished_hand
from fpcad.spec.dump import spec_hash
from fpcad.store import read_json

GAP_MM = 8.0
TOOL_COLOUR = "#b98b52"
ROW_MM = 320.0


def main(build: Path) -> None:
    """Write NAME-parts.png, -finger-apart.png, -finger-cut.png, -hand.png, and one for each pose."""
    spec, geometry = finished_hand(build)
    assembly = read_inventory(build / "parts")
    stamp = Stamp(spec.name, read_json(build / "selected.json")["id"], spec_hash(spec))
    images = Path("docs") / "images"
    rows, x, y, deep = [], 0.0, 0.0, 0.0
    for part in assembly.parts:
        mesh = on_bed(part, spec.print)
        size = np.ptp(mesh.bounds, axis=0)
        if x + size[0] > ROW_MM:
            x, y, deep = 0.0, y - deep - GAP_MM, 0.0
        mesh.apply_translation((x - mesh.bounds[0, 0], y - mesh.bounds[1, 1], 0))
        x, deep = x + size[0] + GAP_MM, max(deep, size[1])
        rows.append((mesh, COLOURS[part.material]))
    draw(rows, images / f"{spec.name}-parts.png", (0.3, -1.0, 0.9), stamp)
    apart = finger_pieces(assembly, geometry, apart=True)
    draw(apart, images / f"{spec.name}-finger-apart.png", (0.3, -1.0, 0.5), stamp)
    cut = cut_open(finger_pieces(assembly, geometry, apart=False))
    draw(cut, images / f"{spec.name}-finger-cut.png", (0.0, -1.0, 1e-4), stamp)
    whole = hand_pieces(assembly, geometry, rest_joints(spec.hand, geometry))
    draw(whole, images / f"{spec.name}-hand.png", (0.55, -1.0, 0.3), stamp)
    for file in sorted((build / "trajectories").glob("*.json")):
        at = hand_postures(spec.hand, geometry, {file.stem: read_trajectory(file)})[1]
        assert at.tool is not None
        held = tool_mesh(spec.tool, 0.0).apply_transform(at.tool[0])
        pieces = [*hand_pieces(assembly, geometry, at.joints[0]), (held, TOOL_COLOUR)]
        draw(pieces, images / f"{spec.name}-holds-{file.stem}.png", (0.55, -1.0, 0.3), stamp)
    base = mounting(spec, geometry, finger_dimensions(spec, geometry)).T_palm_base
    files = sorted((build / "trajectories").glob("*.json"))
    trajectories = {file.stem: read_trajectory(file) for file in files}
    stand = make_stand(spec, geometry, assembly, base, trajectories)
    for pose in stand.jigs:
        pieces = stand_pieces(stand, assembly, geometry, pose, spec.tool)
        draw(pieces, images / f"{spec.name}-jig-{pose}.png", (0.9, -1.0, 0.5), stamp)
    palm = [p for p in assembly.parts if p.link == "palm" and p.name.startswith("palm")]
    below = [(part.mesh, COLOURS[part.material]) for part in palm]
    draw(below, images / f"{spec.name}-palm-pad.png", (0.3, -0.8, -1.0), stamp)


main(Path(sys.argv[1]))
