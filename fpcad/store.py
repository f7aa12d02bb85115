"""Files that survive a kill at any moment: written aside, synced, renamed; shards never change."""

from __future__ import annotations

import fcntl
import json
import os
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from fpcad.errors import StoreError

LOCK = ".lock"
PART = ".part"
"""Ending of files that are being written."""


@contextmanager
def exclusive(folder: Path) -> Iterator[None]:
    """Be the only process that writes to a folder; :class:`StoreError` where another one does.

    The lock ends with the process, however it ends. What a killed one left half written is removed.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / LOCK).open("a") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise StoreError(
                f"{folder}: another fpcad is at work here; wait for its end, or take another folder "
                "with --build"
            ) from None
        for stray in folder.rglob(f".*{PART}"):
            stray.unlink()
        yield


@contextmanager
def waiting_for(folder: Path) -> Iterator[None]:
    """One process at a time in a folder; the others wait."""
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / LOCK).open("a") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


@contextmanager
def replacing(target: Path) -> Iterator[Path]:
    """A file beside `target` to write to; it takes the target's place when the block succeeds."""
    target.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.", suffix=PART)
    beside = Path(name)
    try:
        os.fchmod(handle, 0o644)
        os.close(handle)
        yield beside
        _sync(beside)
        beside.replace(target)
        _sync(target.parent)
    finally:
        beside.unlink(missing_ok=True)


def write_whole(target: Path, content: bytes | str) -> Path:
    """Write a file, its folders too, as a whole or not at all; a kill leaves the old or the new."""
    with replacing(target) as beside:
        beside.write_bytes(content.encode("utf-8") if isinstance(content, str) else content)
    return target


def write_json(target: Path, value: Any) -> None:
    """Write JSON as a whole or not at all; numbers keep all their digits."""
    write_whole(target, json_text(value))


def json_text(value: Any) -> str:
    """JSON as fpcad writes it; numbers keep all their digits."""
    return json.dumps(value, indent=2, allow_nan=False) + "\n"


def read_json(source: Path) -> Any:
    """Read a JSON file; :class:`StoreError` where it is not one."""
    try:
        return json.loads(source.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise StoreError(
            f"{source}: not readable as JSON ({error}); make the design again"
        ) from error


def write_table(target: Path, table: pa.Table) -> None:
    """Write a Parquet file as a whole or not at all."""
    with replacing(target) as beside:
        pq.write_table(table, beside, compression="zstd")


def write_tables(target: Path, schema: pa.Schema, tables: Iterable[pa.Table]) -> None:
    """Write one Parquet file of many tables as a whole or not at all, one table in memory at a time."""
    with (
        replacing(target) as beside,
        pq.ParquetWriter(beside, schema, compression="zstd") as writer,
    ):
        for table in tables:
            if table.num_rows:
                writer.write_table(table)


def read_table(source: Path, rows: pc.Expression | None = None) -> pa.Table:
    """Read a Parquet file, or only some rows of it; :class:`StoreError` where it is not one."""
    try:
        return pq.read_table(source, filters=rows)
    except (OSError, pa.ArrowInvalid) as error:
        raise StoreError(
            f"{source}: not readable as Parquet ({error}); make the design again"
        ) from error


@dataclass(frozen=True)
class Shards:
    """Rows of a running stage, in immutable numbered Parquet files."""

    folder: Path

    def append(self, table: pa.Table, **attachments: pa.Table) -> None:
        """Add one shard after the present ones.

        Attachments are written before it, so that a shard that is there has all of its own.
        """
        stem = f"{len(self.files()):06d}"
        for name, attachment in attachments.items():
            write_table(self.folder / f"{name}-{stem}.parquet", attachment)
        write_table(self.folder / f"{stem}.parquet", table)

    def rows(self) -> list[dict[str, Any]]:
        """All rows in the order in which they were appended."""
        return [row for file in self.files() for row in read_table(file).to_pylist()]

    def attachment(self, name: str, number: int) -> pa.Table:
        """The attachment of a shard."""
        return read_table(self.folder / f"{name}-{number:06d}.parquet")

    def attachment_numbers(self, name: str) -> set[int]:
        """Numbers of the shards that have an attachment of this name."""
        return {int(file.stem.rpartition("-")[2]) for file in self.folder.glob(f"{name}-*.parquet")}

    def drop_attachments(self, name: str) -> None:
        """Remove all attachments of one name, for good."""
        for file in self.folder.glob(f"{name}-*.parquet"):
            file.unlink()

    def files(self) -> list[Path]:
        """Shards in order; :class:`StoreError` where one is missing in between."""
        files = sorted(self.folder.glob("[0-9]*.parquet"))
        for number, file in enumerate(files):
            if file.stem != f"{number:06d}":
                raise StoreError(
                    f"{self.folder}: shard {number:06d} is missing; make the design again"
                )
        return files


def _sync(path: Path) -> None:
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
