"""A run's table: one row a sample, Parquet or CSV by the file's ending.

`build/NAME/runs/POSE-TIME.parquet` is where runs leave it by themselves. Columns: `device_s`, `path_s`,
`state`, `cause`, `queued_knots`, `bad_frames`, `gaps`, `resends`; for each joint `_position_rad`,
`_command_rad`, `_error_rad`, `_preload_rad`; for each motor `_current_ma`, `_temperature_c`, empty where
the motors tell nothing.
"""

from __future__ import annotations

import csv
import os
from pathlib import Path
from types import TracebackType
from typing import Any, Protocol

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from fpcad.run.driver import Array, Sample

_ROWS_AT_ONCE = 500
_HEAD = (
    ("device_s", pa.float64()),
    ("path_s", pa.float64()),
    ("state", pa.string()),
    ("cause", pa.string()),
    ("queued_knots", pa.int32()),
    ("bad_frames", pa.int32()),
    ("gaps", pa.int32()),
    ("resends", pa.int32()),
)
_OF_JOINTS = ("position_rad", "command_rad", "error_rad", "preload_rad")
_OF_MOTORS = ("current_ma", "temperature_c")


class RunLog:
    """The table of a run; one that fails leaves its table too. Without a path nothing is written."""

    def __init__(
        self, path: Path | None, joint_names: tuple[str, ...], motor_names: tuple[str, ...] = ()
    ) -> None:
        self._path = path
        motors = motor_names or tuple(f"motor_{i}" for i in range(1, len(joint_names) + 1))
        columns = [(f"{name}_{what}", pa.float64()) for what in _OF_JOINTS for name in joint_names]
        columns += [(f"{name}_{what}", pa.float64()) for what in _OF_MOTORS for name in motors]
        self._schema = pa.schema([*_HEAD, *columns])
        self._motors = len(motors)

    def __enter__(self) -> RunLog:
        if self._path is not None:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            self._partial = self._path.with_name(self._path.name + ".partial")
            writer = _ParquetRows if self._path.suffix == ".parquet" else _CsvRows
            self._rows: _Rows = writer(self._partial, self._schema)
        return self

    def add(self, sample: Sample) -> None:
        """Write one row."""
        if self._path is not None:
            self._rows.add(self._row(sample))

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if self._path is not None:
            self._rows.close()
            with self._partial.open("rb") as file:
                os.fsync(file.fileno())
            os.replace(self._partial, self._path)

    def _row(self, sample: Sample) -> list[Any]:
        head = [sample.device_s, sample.path_s, sample.state, sample.cause]
        head += [sample.queued_knots, sample.bad_frames, sample.gaps, sample.resends]
        nothing = np.zeros(len(sample.position_rad))
        preload = nothing if sample.preload_rad is None else sample.preload_rad
        for column in (sample.position_rad, sample.command_rad, sample.error_rad, preload):
            head += column.tolist()
        for told in (sample.current_ma, sample.temperature_c):
            head += self._told(told)
        return head

    def _told(self, values: Array | None) -> list[float | None]:
        return [None] * self._motors if values is None else values.tolist()


class _Rows(Protocol):
    def __init__(self, path: Path, schema: pa.Schema) -> None: ...

    def add(self, row: list[Any]) -> None: ...

    def close(self) -> None: ...


class _CsvRows:
    def __init__(self, path: Path, schema: pa.Schema) -> None:
        self._file = path.open("w", newline="", encoding="utf-8")
        self._rows = csv.writer(self._file)
        self._rows.writerow(schema.names)

    def add(self, row: list[Any]) -> None:
        self._rows.writerow(row)

    def close(self) -> None:
        self._file.close()


class _ParquetRows:
    def __init__(self, path: Path, schema: pa.Schema) -> None:
        self._schema = schema
        self._writer = pq.ParquetWriter(path, schema, compression="zstd")
        self._waiting: list[list[Any]] = []

    def add(self, row: list[Any]) -> None:
        self._waiting.append(row)
        if len(self._waiting) >= _ROWS_AT_ONCE:
            self._flush()

    def close(self) -> None:
        self._flush()
        self._writer.close()

    def _flush(self) -> None:
        if self._waiting:
            columns = zip(*self._waiting, strict=True)
            arrays = [
                pa.array(list(column), field.type)
                for column, field in zip(columns, self._schema, strict=True)
            ]
            self._writer.write_table(pa.Table.from_arrays(arrays, schema=self._schema))
            self._waiting.clear()
