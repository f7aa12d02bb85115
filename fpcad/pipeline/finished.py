"""A finished build's spec and chosen hand, read from its files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fpcad.errors import StoreError
from fpcad.make.documents.inventory import read_inventory
from fpcad.make.documents.one_finger import write_finger
from fpcad.make.documents.stamp import Stamp
from fpcad.model.geometry import HandGeometry, hand_geometry
from fpcad.model.hand import hand_template
from fpcad.pipeline.select import SELECTED
from fpcad.sample.space import design_space
from fpcad.spec.dump import spec_hash
from fpcad.spec.load import load_spec
from fpcad.spec.schema import Spec
from fpcad.store import read_json


def finished_hand(folder: Path) -> tuple[Spec, HandGeometry]:
    """The spec of a build folder and the geometry of the hand that was chosen in it."""
    spec_file, selected = folder / "spec.yaml", folder / SELECTED
    if not (spec_file.is_file() and selected.is_file()):
        raise StoreError(
            f"{folder}: no hand was chosen here; run `fpcad design {folder.name}` first"
        )
    spec = load_spec(spec_file)
    return spec, hand_geometry(hand_template(spec.hand), chosen_design(spec, folder))


def chosen_design(spec: Spec, folder: Path) -> NDArray[np.float64]:
    """The design (n_d,) [mm, rad] that was chosen in a build folder."""
    space, named = design_space(spec.hand), read_json(folder / SELECTED)["design"]
    return space.internal(np.array([named[name] for name in space.names]))


def export_finger(folder: Path, finger: str) -> Path:
    """Write one finger's print files beside the whole hand's, and return their folder."""
    spec, geometry = finished_hand(folder)
    chosen = int(read_json(folder / SELECTED)["id"])
    stamp = Stamp(spec.name, chosen, spec_hash(spec))
    assembly = read_inventory(folder / "parts")
    target = folder / "parts" / f"finger_{finger}"
    write_finger(spec, assembly, geometry, finger, target, stamp)
    return target
