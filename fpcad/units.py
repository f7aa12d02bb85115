"""Conversions between the units of specs and tables (mm, deg), of the mechanics (mm, rad) and SI."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

RAD_PER_DEG = np.pi / 180.0
DEG_PER_RAD = 180.0 / np.pi
M_PER_MM = 1e-3
NM_PER_NMM = 1e-3


def internal_factor(name: str) -> float:
    """Factor from the unit in a name's suffix to the mechanics' unit: rad for `_deg`, else 1."""
    return RAD_PER_DEG if name.endswith("_deg") else 1.0


def to_internal(names: Sequence[str], values: Mapping[str, float]) -> NDArray[np.float64]:
    """Values (n,) in the mechanics' units [mm, rad], in the order of `names`."""
    return np.array([values[name] * internal_factor(name) for name in names])


def to_named(
    names: Sequence[str], values: Sequence[float] | NDArray[np.float64]
) -> dict[str, float]:
    """Inverse of :func:`to_internal`: values by name, in the units of the names' suffixes."""
    return {
        name: float(value) / internal_factor(name)
        for name, value in zip(names, values, strict=True)
    }
