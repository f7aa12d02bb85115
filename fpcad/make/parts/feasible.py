"""Whether a design can hold its hardware, from its numbers alone: long before any solid is modelled."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fpcad.errors import MakeError
from fpcad.make.parts.dimensions import finger_dimensions, reasons
from fpcad.make.parts.mounting import flange_and_box
from fpcad.model.geometry import hand_geometry
from fpcad.model.hand import HandTemplate
from fpcad.spec.schema import Spec


def why_not(spec: Spec, template: HandTemplate, design: NDArray[np.float64]) -> list[str]:
    """Every reason why the hand with design vector (n_d,) [mm, rad] cannot be made; empty if none.

    Takes some milliseconds. Words are those of the :class:`fpcad.errors.MakeError` that making the
    hand would raise: `bearing BUSH-2 needs 12.6 mm, finger is 12.4 mm`.
    """
    geometry = hand_geometry(template, design)
    found = reasons(spec, geometry)
    if not found:
        try:
            flange_and_box(spec, geometry, finger_dimensions(spec, geometry))
        except MakeError as error:
            return [str(error)]
    return found
