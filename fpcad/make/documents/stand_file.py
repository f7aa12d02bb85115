"""parts/stand.json: how stand and jigs stand to the hand, so that their files can be checked again."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from fpcad.errors import StoreError
from fpcad.make.documents.inventory import read_mesh
from fpcad.make.documents.print_ready import FOLDER as PRINT
from fpcad.make.documents.stamp import Stamp
from fpcad.make.documents.step_files import read_step
from fpcad.make.gates.orientation import part_orientation
from fpcad.make.parts.part import FIXED_LINK, Part
from fpcad.make.stand.scene import pose_scene
from fpcad.make.stand.stand import JIG, Stand
from fpcad.make.trajectory import Trajectory
from fpcad.model.geometry import HandGeometry
from fpcad.spec.hardware import Print
from fpcad.spec.schema import Spec
from fpcad.store import read_json

FILE = "stand.json"


def write_stand(stand: Stand, settings: Print, folder: Path, stamp: Stamp) -> Path:
    """Write the file into a build's `parts` folder, beside the parts' own."""
    document = {
        "unit": "mm",
        "T_palm_stand": stand.T_palm_stand.tolist(),
        "parts": [_part(part, settings) for part in stand.parts],
        "away": {pose: list(map(float, away)) for pose, away in stand.away.items()},
    }
    return stamp.write(folder / FILE, json.dumps(document, indent=1, allow_nan=False) + "\n")


def read_stand(
    spec: Spec, geometry: HandGeometry, trajectories: Mapping[str, Trajectory], folder: Path
) -> Stand:
    """The stand as the files of a `parts` folder tell it; the meshes are those that are printed."""
    document = read_json(folder / FILE)
    try:
        T = np.array(document["T_palm_stand"], dtype=float).reshape(4, 4)
        parts = tuple(_read_part(row, folder) for row in document["parts"])
        away = {pose: np.array(a, dtype=float) for pose, a in document["away"].items()}
        scenes = {
            pose: pose_scene(spec, geometry, pose, trajectories[pose], T)
            for pose in (p.name.removeprefix(JIG) for p in parts if p.name.startswith(JIG))
        }
    except (KeyError, TypeError, ValueError) as error:
        raise StoreError(f"{folder / FILE}: not as fpcad writes it ({error!r})") from error
    return Stand(T, parts, scenes, away, ())


def _part(part: Part, settings: Print) -> dict[str, Any]:
    return {
        "name": part.name,
        "mesh": f"{PRINT}/{part.name}.stl",
        "solid": f"step/{part.name}.step",
        "T_bed_part": part_orientation(part, settings).T_bed_part.tolist(),
    }


def _read_part(row: Mapping[str, Any], folder: Path) -> Part:
    T_bed_part = np.array(row["T_bed_part"], dtype=float).reshape(4, 4)
    mesh = read_mesh(folder / row["mesh"]).apply_transform(np.linalg.inv(T_bed_part))
    solid = read_step(folder / row["solid"])
    return Part(row["name"], FIXED_LINK, "endoskeleton", 1, solid, mesh, T_bed_part=T_bed_part)
