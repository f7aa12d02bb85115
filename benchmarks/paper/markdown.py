"""Pieces of a Markdown document."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from scipy.stats import binomtest

CONFIDENCE = 0.95


def table(headings: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A table; the first column to the left, the others to the right."""
    rule = ["---", *["---:"] * (len(headings) - 1)]
    lines = [headings, rule, *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)


def share(part: int, whole: int, digits: int = 2) -> str:
    """A share with its counts."""
    return "none" if whole == 0 else f"{part / whole:.{digits}%} ({part:,} of {whole:,})"


def interval(part: int, whole: int) -> str:
    """A share in per cent with its exact binomial interval (Clopper and Pearson)."""
    if whole == 0:
        return "-"
    low, high = confidence(part, whole)
    return f"{100 * part / whole:.1f} [{100 * low:.1f}, {100 * high:.1f}]"


def confidence(part: int, whole: int) -> tuple[float, float]:
    """Bounds of the exact two-sided binomial interval at CONFIDENCE."""
    bounds = binomtest(part, whole).proportion_ci(CONFIDENCE, method="exact")
    return float(bounds.low), float(bounds.high)
