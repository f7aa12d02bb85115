"""Loads as a file: parts/loads.csv."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable
from dataclasses import dataclass

FILE = "loads.csv"
ANY = "any"
"""In place of a pose, where all are alike."""
COLUMNS = ("pose", "case", "what", "where", "load", "limit", "unit", "share", "at_deg")


@dataclass(frozen=True)
class Load:
    """The worst of one kind of load in one case of one pose."""

    pose: str
    case: str
    what: str
    """`motor torque`, `strand`, `bearing` and so on."""
    where: str
    """The motor, or the finger and its part."""
    load: float
    limit: float
    unit: str
    at_deg: float | None = None
    """Turn of the tool [deg] at which it is so, where one can be told."""

    @property
    def share(self) -> float:
        """Load over limit; over 1 it is too much."""
        return self.load / self.limit


def loads_csv(loads: Iterable[Load]) -> str:
    """One line for each load."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(COLUMNS)
    for row in loads:
        figures = f"{row.load:.4g}", f"{row.limit:.4g}", row.unit, f"{row.share:.3f}"
        at = "" if row.at_deg is None else f"{row.at_deg:.1f}"
        writer.writerow([row.pose, row.case, row.what, row.where, *figures, at])
    return stream.getvalue()
