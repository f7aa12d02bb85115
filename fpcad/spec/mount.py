"""How the hand is fixed, and where its motors are."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from fpcad.spec.base import Positive, SpecModel
from fpcad.spec.catalogue import flange_sizes


class Mount(SpecModel):
    """The flange on the palm's back, and the box of motors behind it."""

    flange: Annotated[str, Field(json_schema_extra={"enum": [*flange_sizes()]})] = (
        "ISO9409-1-50-4-M6"
    )
    """Size of the flange, a row of data/flanges.csv."""
    stem_mm: Annotated[float, Field(ge=60, le=200)] = 80.0
    """From the palm's back to the flange's face [mm]: a longer stem bends the tubes less."""
    box: bool = True
    """Whether the box of motors sits on the flange; otherwise it stands elsewhere."""
    tube_mm: Positive = 500.0
    """Length of each tube where the box stands elsewhere [mm]."""
