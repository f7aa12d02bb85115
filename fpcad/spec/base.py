"""What all parts of a spec share: strictness, immutability and small value types."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, BaseModel, ConfigDict, Field
from pydantic_core import PydanticCustomError


class SpecModel(BaseModel):
    """A frozen part of a spec in which an unknown key is an error."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", allow_inf_nan=False, use_attribute_docstrings=True
    )


def rejection(allowed: str, at: str | None = None) -> PydanticCustomError:
    """The error with which a validator tells what is allowed, and at which of its keys."""
    return PydanticCustomError("fault", "{allowed}", {"allowed": allowed, "at": at})


def _ordered(interval: tuple[float, float]) -> tuple[float, float]:
    low, high = interval
    if low > high:
        raise rejection("a range [low, high] with low <= high")
    return interval


Interval = Annotated[tuple[float, float], AfterValidator(_ordered)]
"""A closed range [low, high] with low <= high."""

Vector3 = tuple[float, float, float]
"""Three numbers along x, y, z."""

NAME_PATTERN = r"^[a-z][a-z0-9_-]{0,39}$"
Name = Annotated[str, Field(pattern=NAME_PATTERN)]
"""A name that is also a file name: up to 40 lower-case letters, digits, - and _; a letter first."""

Positive = Annotated[float, Field(gt=0)]
NonNegative = Annotated[float, Field(ge=0)]
Fraction = Annotated[float, Field(gt=0, le=1)]
