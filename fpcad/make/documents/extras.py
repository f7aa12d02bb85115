"""What helps to build and try a hand and is no part of it: fit coupon, the tool, one finger's mount."""

from __future__ import annotations

import numpy as np

from fpcad.make.mesh import mesh_of
from fpcad.make.parts.part import Part
from fpcad.make.parts.solids import Solid, box, rod
from fpcad.spec.schema import Spec

COUPON_PIN_MM = 2.0
"""Diameter of the pin that the coupon is tried with."""
COUPON_STEPS_MM = (-0.2, -0.1, 0.0, 0.1, 0.2)
"""Added to the clearance, hole by hole; one notch marks the first."""
PITCH_MM = 8.0
THICK_MM = 6.0


def extra_parts(spec: Spec) -> list[Part]:
    """The coupon and the tool as printed parts of their own."""
    made = (("fit_coupon", fit_coupon(spec)), ("tool", tool_solid(spec)))
    return [
        Part(name, "palm", "endoskeleton", 1, solid, mesh_of(name, solid, spec.print))
        for name, solid in made
    ]


def fit_coupon(spec: Spec) -> Solid:
    """A bar with a row of holes for one pin, from tight to loose, and a gap gauge at its end.

    The middle hole is the one that the spec's clearance gives; a notch beside the first hole tells
    where the row begins.
    """
    length = PITCH_MM * (len(COUPON_STEPS_MM) + 1)
    bar = box((0, -5, 0), (length, 5, THICK_MM))
    for number, step in enumerate(COUPON_STEPS_MM, start=1):
        radius = (COUPON_PIN_MM + spec.print.clearance_mm + step) / 2
        x = number * PITCH_MM
        bar = bar.cut(rod((x, 0, -1), (x, 0, THICK_MM + 1), radius))
    return bar.cut(box((PITCH_MM - 1, 4, -1), (PITCH_MM + 1, 6, THICK_MM + 1))).clean()


def tool_solid(spec: Spec) -> Solid:
    """The tool itself, in its frame O."""
    tool = spec.tool
    return rod(np.array([tool.back_mm, 0, 0]), np.array([tool.tip_mm, 0, 0]), tool.radius_mm)
