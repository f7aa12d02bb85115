"""Findings as a file: parts/checks.csv."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable

from fpcad.make.gates.finding import Finding

FILE = "checks.csv"
COLUMNS = (
    *("gate", "severity", "part", "value", "limit", "unit"),
    *("x_mm", "y_mm", "z_mm", "text"),
)


def findings_csv(findings: Iterable[Finding]) -> str:
    """One line for each finding; the location is in the frame of the part's link."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(COLUMNS)
    for f in findings:
        figures = f"{f.value:.6g}", f"{f.limit:.6g}"
        writer.writerow(
            [f.gate, f.severity.value, f.part, *figures, f.unit, *(f.at_mm or ("",) * 3), f.text]
        )
    return stream.getvalue()
