"""A finished build's spec and chosen hand, read from its files."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fpcad.errors import StoreError
from fpcad.model.geometry import HandGeometry, hand_geometry
from fpcad.model.hand import hand_template
from fpcad.sample.space import design_space
from fpcad.spec.load import load_spec
from fpcad.spec.schema import Spec
from fpcad.store import read_json


def finished_hand(folder: Path) -> tuple[Spec, HandGeometry]:
    """The spec of a build folder and the geometry of the hand that was chosen in it."""
    spec_file, selected = folder / "spec.yaml", folder / "selected.json"
    if not (spec_file.is_file() and selected.is_file()):
        raise StoreError(
            f"{folder}: no hand was chosen here; run `fpcad design {folder.name}` first"
        )
    spec = load_spec(spec_file)
    space = design_space(spec.hand)
    design = read_json(selected)["design"]
    named = np.array([design[name] for name in space.names])
    return spec, hand_geometry(hand_template(spec.hand), space.internal(named))
