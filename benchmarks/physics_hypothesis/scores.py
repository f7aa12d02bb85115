"""Hands' results as counts, shares and rank correlations."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.stats import rankdata

KINEMATIC = ("tmr_deg", "mss_mm_s", "mft_nmm", "mft_p90_nmm", "tip_force_n")
"""Metrics of a path that the selection may score."""
SHARES = (0.5, 0.9)

Result = dict[str, Any]


def read_results(folder: Path) -> list[Result]:
    """All hands' results, in the order of their ids."""
    files = sorted(folder.glob("*.json"), key=lambda file: int(file.stem))
    return [json.loads(file.read_text(encoding="utf-8")) for file in files]


def poses_of(results: Sequence[Result]) -> list[str]:
    """All poses that some hand was tried in."""
    return list(dict.fromkeys(pose for result in results for pose in result["poses"]))


def loads_of(results: Sequence[Result]) -> list[str]:
    """All loads that some hand was tried with."""
    return list(
        dict.fromkeys(
            load
            for result in results
            for told in result["poses"].values()
            for load in told["trials"]
        )
    )


class Score(NamedTuple):
    """What one hand did."""

    held: bool
    wielded: bool
    """Held to the end, and never tipped."""
    share: float
    """Of the planned range, passed before the tool tipped or was lost."""


def scores(results: Iterable[Result], load: str, pose: str) -> list[Score]:
    """What each hand did; the worst pose for `all`."""
    found = []
    for result in results:
        names = [*result["poses"], *result["faults"]] if pose == "all" else [pose]
        each = [_score(result, load, name) for name in names]
        found.append(Score(*(min(column) for column in zip(*each, strict=True))))
    return found


def reached_counts(results: Sequence[Result], load: str, pose: str) -> tuple[int, ...]:
    """How many hands hold the tool to the end, never tip it, and of those that hold it pass each of `SHARES`."""
    each = scores(results, load, pose)
    passed = (sum(one.held and one.share >= least for one in each) for least in SHARES)
    return sum(one.held for one in each), sum(one.wielded for one in each), *passed


def rank_correlation(
    results: Sequence[Result], load: str, pose: str, kind: str, name: str
) -> float | None:
    """Spearman's, of a figure and the share that was reached while held; None without variety."""
    there = [result for result in results if pose in result["poses"]]
    reached = [score.share if score.held else 0.0 for score in scores(there, load, pose)]
    figures = [result["poses"][pose][kind][name] for result in there]
    if len(set(reached)) < 2 or len(set(figures)) < 2:
        return None
    return float(np.corrcoef(rankdata(figures), rankdata(reached))[0, 1])


def _score(result: Result, load: str, pose: str) -> Score:
    if pose not in result["poses"]:
        return Score(False, False, 0.0)
    told = result["poses"][pose]["trials"][load]
    return Score(told["held"], told["wielded"], told["reached_share"])
