"""Hands that the tests of this folder make parts of."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np

from fpcad.make.documents.stamp import Stamp
from fpcad.make.parts.assembly import Assembly, make_assembly
from fpcad.make.parts.part import Part
from fpcad.model.geometry import HandGeometry, hand_geometry
from fpcad.model.hand import hand_template
from fpcad.spec.dump import spec_hash
from fpcad.spec.load import load_spec
from fpcad.spec.schema import Spec
from fpcad.units import to_internal

CLAY = load_spec(Path(__file__).parents[2] / "designs" / "clay.yaml")
TEMPLATE = hand_template(CLAY.hand)
STAMP = Stamp("clay", 24, spec_hash(CLAY))
CENTRE = (42.5, 85.0, 30.0, 16.0, 75.0, 0.0)
CORNERS = (
    (30.0, 50.0, 21.0, 18.0, 120.0, 0.0),
    (55.0, 120.0, 20.5, 12.2, 30.0, -60.0),
    (42.0, 60.0, 22.0, 20.0, 120.0, 60.0),
    (30.0, 120.0, 40.0, 20.0, 60.0, 30.0),
)
"""d1 to d6 [mm, deg]: short and long palms, thin and thick fingers, narrow and wide angles."""


def design(values: tuple[float, ...]) -> np.ndarray:
    """Design vector (6,) [mm, rad] of d1 to d6 [mm, deg]."""
    names = TEMPLATE.names.parameters
    return to_internal(names, dict(zip(names, values, strict=True)))


def geometry_of(values: tuple[float, ...], spec: Spec = CLAY) -> HandGeometry:
    """Geometry of the hand with d1 to d6 [mm, deg]."""
    return hand_geometry(hand_template(spec.hand), design(values))


@cache
def assembly_of(values: tuple[float, ...]) -> Assembly:
    """Clay's hand for d1 to d6 [mm, deg], made once: solid modelling takes seconds."""
    return make_assembly(CLAY, geometry_of(values), lambda _: None)


def parts_of(values: tuple[float, ...]) -> list[Part]:
    """Its printed parts."""
    return list(assembly_of(values).parts)


def with_print(**settings: object) -> Spec:
    """Clay's spec with other print settings."""
    return CLAY.model_copy(update={"print": CLAY.print.model_copy(update=settings)})
