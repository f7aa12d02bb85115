"""Columns of tables as arrays, and back."""

from __future__ import annotations

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from fpcad.errors import StoreError


def numbers(table: pa.Table, name: str) -> NDArray[np.float64]:
    """Values (n,) of a column of numbers or truth values; a missing value becomes NaN."""
    if name not in table.column_names:
        raise StoreError(f"metrics table: no column `{name}`; evaluate the design again")
    return np.asarray(table.column(name).cast(pa.float64()).to_numpy(), dtype=np.float64)


def flags(table: pa.Table, name: str) -> NDArray[np.bool_]:
    """Values (n,) of a column of truth values; a missing value counts as False."""
    return numbers(table, name) == 1.0


def with_column(table: pa.Table, name: str, values: NDArray[np.generic]) -> pa.Table:
    """The table with a column of n values put in place of one of the same name, or at the end."""
    if name in table.column_names:
        return table.set_column(table.column_names.index(name), name, pa.array(values))
    return table.append_column(name, pa.array(values))
