"""What a check found: which part, where, how much, and what is allowed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from fpcad.errors import MakeError

Point = tuple[float, float, float]


class Severity(StrEnum):
    """What a finding means for the hand."""

    ERROR = "error"
    """The hand is not made."""
    WARNING = "warning"
    """The hand is made, and its user is told."""
    FIGURE = "figure"
    """Nothing is wrong; the number is told."""


@dataclass(frozen=True)
class Finding:
    """One figure that a gate measured."""

    gate: str
    severity: Severity
    part: str
    """The part, or the two parts that are too close."""
    value: float
    limit: float
    unit: str
    text: str
    """What was found, in words for people, with the number."""
    at_mm: Point | None = None
    """Where, in the frame of the part (of the first one of two)."""

    def __str__(self) -> str:
        where = "" if self.at_mm is None else " at ({:.1f}, {:.1f}, {:.1f}) mm".format(*self.at_mm)
        return f"{self.part}: {self.text}{where}"


def point(values: Sequence[float] | NDArray[np.float64]) -> Point:
    """A point (3,) [mm] as plain numbers to 1e-3 mm."""
    x, y, z = (round(float(value), 3) + 0.0 for value in values)
    return x, y, z


def errors(findings: Iterable[Finding]) -> list[Finding]:
    """Those of the findings that keep a hand from being made."""
    return [finding for finding in findings if finding.severity is Severity.ERROR]


def refuse_errors(findings: Iterable[Finding]) -> None:
    """Raise :class:`MakeError` with the first error, and how many more there are."""
    found = errors(findings)
    if found:
        more = "" if len(found) == 1 else f" (and {len(found) - 1} more faults; see `fpcad check`)"
        raise MakeError(f"{found[0]}{more}")
