"""Paths of many candidates, read in one pass over paths.parquet and thinned to keyframes."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq
from numpy.typing import NDArray

from fpcad.wield.path import WieldingPath

Array = NDArray[np.float64]

COLUMNS = ["id", "pose", "state", "tool_angle_rad", "joints_rad", "contacts_mm_rad"]


@dataclass(frozen=True)
class PathStates:
    """One candidate's path from one pose; N states by rising tool angle."""

    id: int
    pose: str
    tool_angle_rad: Array  # (N,)
    joints_rad: Array  # (N, n_u)
    contacts: Array  # (N, 4 n)

    def keyframes(self, count: int) -> PathStates:
        """`count` states at even tool angles, both ends and the pose among them.

        Values in between are interpolated linearly, which is also how they are shown.
        """
        low, high = self.tool_angle_rad[0], self.tool_angle_rad[-1]
        angles = np.linspace(low, high, count)
        if low < 0.0 < high:
            nearest = int(np.argmin(np.abs(angles[1:-1]))) + 1
            angles[nearest] = 0.0

        def at(values: Array) -> Array:
            return np.stack([np.interp(angles, self.tool_angle_rad, v) for v in values.T], axis=1)

        return PathStates(self.id, self.pose, angles, at(self.joints_rad), at(self.contacts))


def path_states(candidate: int, path: WieldingPath) -> PathStates:
    """A path that was traced just now."""
    n = len(path.tool_angle_rad)
    joints, contacts = path.joints_rad.reshape(n, -1), path.contacts.reshape(n, -1)
    return PathStates(candidate, path.pose, path.tool_angle_rad, joints, contacts)


def stored_paths(file: Path, wanted: Collection[int]) -> Iterator[PathStates]:
    """The kept paths of the wanted candidates, in the order of the file."""
    if not wanted or not file.exists():
        return
    kept, held = pc.field("id").isin(sorted(wanted)), None
    for batch in pq.ParquetFile(file).iter_batches(columns=COLUMNS):
        rows = pa.Table.from_batches([batch]).filter(kept)
        rows = rows if held is None else pa.concat_tables([held, rows])
        starts = _starts(rows)
        for start, end in pairwise(starts):
            yield _path(rows.slice(start, end - start))
        held = rows.slice(starts[-1]) if len(starts) else rows
    if held is not None and held.num_rows:
        yield _path(held)


def _starts(rows: pa.Table) -> list[int]:
    """Rows at which another path begins."""
    if rows.num_rows == 0:
        return []
    ids, poses = rows["id"].to_numpy(), rows["pose"].to_numpy(zero_copy_only=False)
    changes = (ids[1:] != ids[:-1]) | (poses[1:] != poses[:-1])
    return [0, *(np.flatnonzero(changes) + 1).tolist()]


def _path(rows: pa.Table) -> PathStates:
    rows = rows.combine_chunks()
    n, order = rows.num_rows, np.argsort(rows["state"].to_numpy())

    def lists(name: str) -> Array:
        return rows[name].combine_chunks().flatten().to_numpy().reshape(n, -1)[order]

    return PathStates(
        id=rows["id"][0].as_py(),
        pose=rows["pose"][0].as_py(),
        tool_angle_rad=rows["tool_angle_rad"].to_numpy()[order],
        joints_rad=lists("joints_rad"),
        contacts=lists("contacts_mm_rad"),
    )
