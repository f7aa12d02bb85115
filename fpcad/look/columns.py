"""What the columns of a run's table mean: parameters, metrics and scores, with words and units."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

import pyarrow as pa

from fpcad.select.scores import MEAN_SCORE

Better = Literal["larger", "smaller"]

SUFFIX_UNITS = {"_deg": "°", "_mm": "mm", "_mm_s": "mm/s", "_nmm": "N mm", "_n": "N", "_rad": "rad"}
SCORE = "_score"

KNOWN: dict[str, tuple[str, Better]] = {
    "tmr_deg": ("tool motion range", "larger"),
    "mss_mm_s": ("mean sliding speed", "smaller"),
    "mft_nmm": ("largest finger torque", "smaller"),
    "mft_p90_nmm": ("finger torque, 90th percentile", "smaller"),
    "tip_force_n": ("tip force held by the motors", "larger"),
}
"""Words and direction of fpcad's own metrics; a plug-in's column speaks for itself."""


@dataclass(frozen=True)
class Column:
    """One column of numbers."""

    name: str
    label: str
    unit: str
    pose: str | None = None
    better: Better | None = None


def parameter_columns(names: Iterable[str]) -> list[Column]:
    """Columns of design parameters."""
    return [Column(name, bare_label(name), unit_of(name)) for name in names]


def metric_columns(table: pa.Table, poses: Sequence[str]) -> list[Column]:
    """Columns of metrics, in the order of the table; those of plug-ins are among them."""
    found = []
    for field in table.schema:
        pose = pose_of(field.name, poses)
        if pose is None or field.name.endswith(SCORE) or not pa.types.is_floating(field.type):
            continue
        kind = field.name[len(pose) + 1 :]
        words, better = KNOWN.get(kind, (bare_label(kind), None))
        found.append(Column(field.name, f"{pose}: {words}", unit_of(kind), pose, better))
    return found


def score_columns(table: pa.Table, poses: Sequence[str]) -> list[Column]:
    """Columns of single scores, in the order of the table; the mean is not one of them."""
    found = []
    for name in table.column_names:
        pose = pose_of(name, poses)
        if pose is not None and name.endswith(SCORE) and name != MEAN_SCORE:
            words = name[len(pose) + 1 : -len(SCORE)].replace("_", " ")
            found.append(Column(name, f"{pose}: {words}", "", pose, "larger"))
    return found


def pose_of(column: str, poses: Sequence[str]) -> str | None:
    """The pose that a column tells of: the longest name that it begins with."""
    fitting = [pose for pose in poses if column.startswith(f"{pose}_")]
    return max(fitting, key=len, default=None)


def unit_of(name: str) -> str:
    """Unit in a name's suffix; empty for a name without one."""
    suffixes = [suffix for suffix in SUFFIX_UNITS if name.endswith(suffix)]
    return SUFFIX_UNITS[max(suffixes, key=len)] if suffixes else ""


def bare_label(name: str) -> str:
    """A name without its unit, in words."""
    suffixes = [suffix for suffix in SUFFIX_UNITS if name.endswith(suffix)]
    return name.removesuffix(max(suffixes, key=len, default="")).replace("_", " ")
