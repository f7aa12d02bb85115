"""What all parts of a spec share: strictness, immutability and small value types."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, BaseModel, ConfigDict, Field


class SpecModel(BaseModel):
    """A frozen part of a spec in which an unknown key is an error."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", allow_inf_nan=False, use_attribute_docstrings=True
    )


def _ordered(interval: tuple[float, float]) -> tuple[float, float]:
    low, high = interval
    if low > high:
        raise ValueError(f"a range [low, high] with low <= high, not [{low:g}, {high:g}]")
    return interval


Interval = Annotated[tuple[float, float], AfterValidator(_ordered)]
"""A closed range [low, high] with low <= high."""

Vector3 = tuple[float, float, float]
"""Three numbers along x, y, z."""

Name = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_-]{0,39}$")]
"""A name that is also a file name: lower-case letters, digits, - and _; a letter first."""

Positive = Annotated[float, Field(gt=0)]
NonNegative = Annotated[float, Field(ge=0)]
Fraction = Annotated[float, Field(gt=0, le=1)]
