"""Files that survive a kill at any moment: written aside, synced, renamed; shards never change."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from fpcad.errors import StoreError


@contextmanager
def replacing(target: Path) -> Iterator[Path]:
    """A file beside `target` to write to; it takes the target's place when the block succeeds."""
    target.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
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
    write_whole(target, json.dumps(value, indent=2, allow_nan=False) + "\n")


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


def read_table(source: Path) -> pa.Table:
    """Read a Parquet file; :class:`StoreError` where it is not one."""
    try:
        return pq.read_table(source)
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

    def attachments(self, name: str) -> Iterator[pa.Table]:
        """The attachments of one name, in the order of their shards."""
        for file in self.files():
            yield read_table(file.with_name(f"{name}-{file.name}"))

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
