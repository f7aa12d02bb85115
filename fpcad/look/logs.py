"""Logs of runs on motors: build/NAME/runs, a file a run, as `fpcad run-trajectory` leaves them.

A row is a sample. Columns: `device_s`; for each joint `_position_rad`, `_command_rad`, `_error_rad`; for
each motor `_current_ma` and `_temperature_c`, empty where motors tell nothing; `state`, `cause`.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv
from numpy.typing import NDArray

from fpcad.errors import StoreError
from fpcad.select.columns import numbers
from fpcad.store import read_table
from fpcad.units import DEG_PER_RAD

Array = NDArray[np.float64]

FOLDER = "runs"
MAX_RUNS = 5
POINTS = 300
CLOCK = "device_s"
NO_CAUSE = "NONE"
"""What a controller tells that nothing stopped."""
QUANTITIES = {
    "error": ("_error_rad", "°", DEG_PER_RAD),
    "measured": ("_position_rad", "°", DEG_PER_RAD),
    "command": ("_command_rad", "°", DEG_PER_RAD),
    "current": ("_current_ma", "mA", 1.0),
    "temperature": ("_temperature_c", "°C", 1.0),
}
"""What is drawn: columns' ending, unit shown, factor to it."""


@dataclass(frozen=True)
class Quantity:
    """One quantity of a run, of each joint or each motor that tells it."""

    name: str
    unit: str
    of: tuple[str, ...]
    """k joints or motors."""
    values: Array  # (k, points); NaN where nothing was told


@dataclass(frozen=True)
class RunLog:
    """One run, thinned to what is drawn."""

    name: str
    facts: tuple[tuple[str, str], ...]
    """Subjects and sentences; extremes are those of all samples."""
    seconds: Array  # (points,) since the first sample
    quantities: tuple[Quantity, ...]


def run_logs(folder: Path, warnings: list[str]) -> list[RunLog]:
    """The latest five runs of a build folder, the newest first; what cannot be read is told."""
    files = [f for f in (folder / FOLDER).glob("*") if f.suffix in (".parquet", ".csv")]
    newest = sorted(files, key=lambda f: (f.stat().st_mtime, f.name), reverse=True)
    found = []
    for file in newest[:MAX_RUNS]:
        try:
            found.append(_log(file))
        except (StoreError, pa.ArrowInvalid) as error:
            warnings.append(f"The log of a run is left out: {file.name}: {error}.")
    if len(newest) > MAX_RUNS:
        warnings.append(f"Of {len(newest)} runs' logs the newest {MAX_RUNS} are shown.")
    return found


def _log(file: Path) -> RunLog:
    table = _read(file)
    if CLOCK not in table.column_names or not table.num_rows:
        raise StoreError(f"no samples of a run (rows with a column `{CLOCK}`)")
    clock = numbers(table, CLOCK)
    drawn = np.unique(np.linspace(0, len(clock) - 1, POINTS).astype(int))
    quantities = [_quantity(table, name, drawn) for name in QUANTITIES]
    return RunLog(
        name=file.stem,
        facts=tuple(_facts(table, clock)),
        seconds=(clock - clock[0])[drawn],
        quantities=tuple(q for q in quantities if q.of),
    )


def _read(file: Path) -> pa.Table:
    return read_table(file) if file.suffix == ".parquet" else pyarrow.csv.read_csv(file)


def _quantity(table: pa.Table, name: str, drawn: NDArray[np.int64]) -> Quantity:
    ending, unit, factor = QUANTITIES[name]
    columns = [c for c in table.column_names if c.endswith(ending)]
    values = {c.removesuffix(ending): factor * numbers(table, c)[drawn] for c in columns}
    told = {name: v for name, v in values.items() if np.isfinite(v).any()}
    return Quantity(name, unit, tuple(told), np.array(list(told.values())).reshape(-1, len(drawn)))


def _facts(table: pa.Table, clock: Array) -> list[tuple[str, str]]:
    """Duration, extremes over all samples, and how the run ended."""
    facts = [("Samples", f"{table.num_rows} in {clock[-1] - clock[0]:.1f} s")]
    words = {"error": "Largest error", "current": "Largest current", "temperature": "Hottest motor"}
    for name, title in words.items():
        ending, unit, factor = QUANTITIES[name]
        peaks = {
            c.removesuffix(ending): np.nanmax(np.abs(values))
            for c in table.column_names
            if c.endswith(ending) and np.isfinite(values := factor * numbers(table, c)).any()
        }
        if peaks:
            worst = max(peaks, key=lambda of: peaks[of])
            digits = 2 if unit == "°" else 0
            facts.append((title, f"{peaks[worst]:.{digits}f} {unit} ({worst})"))
    if {"state", "cause"} <= set(table.column_names):
        state, cause = (table[name][-1].as_py() for name in ("state", "cause"))
        facts.append(
            ("Ended", f"{state}" if cause in ("", None, NO_CAUSE) else f"{state}: {cause}")
        )
    return facts
