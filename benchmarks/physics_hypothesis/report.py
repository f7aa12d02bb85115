"""From the hands' result files to a page of tables."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import rankdata

KINEMATIC = ("tmr_deg", "mss_mm_s", "mft_nmm", "mft_p90_nmm", "tip_force_n")
"""Metrics of a path that the selection may score."""
OF_GRIP = ("slip_margin_n", "cone_share", "motor_share", "least_stiffness_n_mm", "tip_force_n")
"""Margins of the preload, for comparison."""
SHARES = (0.5, 0.9)

Result = dict[str, Any]


def read_results(folder: Path) -> list[Result]:
    """All hands' results, in the order of their ids."""
    files = sorted(folder.glob("*.json"), key=lambda file: int(file.stem))
    return [json.loads(file.read_text(encoding="utf-8")) for file in files]


def page(results: Sequence[Result], about: str) -> str:
    """The page in Markdown; `about` says what was run, and how."""
    poses = list(dict.fromkeys(pose for result in results for pose in result["poses"]))
    loads = _loads(results)
    faults = sum(bool(result["faults"]) for result in results)
    parts = [
        "# Does the paper's claim hold in physics?",
        about,
        f"{len(results)} hands with a kinematic tool motion range greater than zero in all poses; "
        f"{faults} of them have a pose for which no trajectory or no grip could be made, which counts "
        "as not held.",
        "## Hands that keep hold of the tool and reach half and nine tenths of their planned range",
        _table(
            ["load", "pose", "held to the end", "reached 50 %", "reached 90 %", "median share"],
            [_row(results, load, pose) for load in loads for pose in [*poses, "all"]],
        ),
        "`reached` counts hands that held the tool to the end *and* passed that share of their planned "
        "range; the median is over all hands, what a hand turned before it lost the tool included. "
        "`all` asks it of every pose of a hand. In brackets: 95 % intervals (Wilson).",
        "## Which figure predicts it?",
        "Spearman's rank correlation over hands between a figure of the path and the share of the "
        "planned range that was reached while the tool was held (0 where it was lost). `metric`: what "
        "the search knows; `grip`: margins of the preload.",
        _table(
            ["figure", *[f"{pose}, {load}" for load in loads[:3] for pose in poses]],
            [
                [f"{kind} {name}", *[_rank(results, load, pose, kind, name) for load in loads[:3] for pose in poses]]
                for kind, names in (("metrics", KINEMATIC), ("margins", OF_GRIP))
                for name in names
            ],
        ),
    ]  # fmt: skip
    return "\n\n".join(parts) + "\n"


def _loads(results: Sequence[Result]) -> list[str]:
    return list(
        dict.fromkeys(
            load
            for result in results
            for told in result["poses"].values()
            for load in told["trials"]
        )
    )


def _scores(results: Iterable[Result], load: str, pose: str) -> list[tuple[bool, float]]:
    """Whether each hand held, and its share of the planned range; the worst pose for `all`."""
    found = []
    for result in results:
        names = [*result["poses"], *result["faults"]] if pose == "all" else [pose]
        each = [_score(result, load, name) for name in names]
        found.append((all(held for held, _ in each), min(share for _, share in each)))
    return found


def _score(result: Result, load: str, pose: str) -> tuple[bool, float]:
    if pose not in result["poses"]:
        return False, 0.0
    told = result["poses"][pose]["trials"][load]
    return told["held"], told["reached_deg"] / told["planned_deg"]


def _row(results: Sequence[Result], load: str, pose: str) -> list[str]:
    scores = _scores(results, load, pose)
    reached = [sum(held and share >= least for held, share in scores) for least in SHARES]
    held = sum(held for held, _ in scores)
    median = float(np.median([share for _, share in scores]))
    counts = [_share(count, len(scores)) for count in (held, *reached)]
    return [load, pose, *counts, f"{median:.2f}"]


def _share(count: int, n: int) -> str:
    """Percentage with its Wilson interval."""
    z, p = 1.959964, count / n
    centre = (p + z * z / (2 * n)) / (1 + z * z / n)
    half = z * np.sqrt(p * (1 - p) / n + z * z / (4 * n * n)) / (1 + z * z / n)
    low, high = max(0.0, centre - half), min(1.0, centre + half)
    return f"{p:.0%} ({count}) [{low:.0%}, {high:.0%}]"


def _rank(results: Sequence[Result], load: str, pose: str, kind: str, name: str) -> str:
    there = [result for result in results if pose in result["poses"]]
    reached = [
        share if held else 0.0 for held, share in (_score(result, load, pose) for result in there)
    ]
    figures = [result["poses"][pose][kind][name] for result in there]
    if len(set(reached)) < 2 or len(set(figures)) < 2:
        return "-"
    return f"{np.corrcoef(rankdata(figures), rankdata(reached))[0, 1]:+.2f}"


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)
