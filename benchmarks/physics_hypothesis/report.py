"""From the hands' results to a page of tables."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from benchmarks.physics_hypothesis.scores import (
    KINEMATIC,
    Result,
    loads_of,
    poses_of,
    rank_correlation,
    reached_counts,
    scores,
)
from benchmarks.physics_hypothesis.summary import IN_SHORT, in_short
from fpcad.simulate.measure import TIPPED_DEG

OF_GRIP = ("slip_margin_n", "cone_share", "motor_share", "least_stiffness_n_mm", "tip_force_n")
"""Margins of the preload, for comparison."""


def page(results: Sequence[Result], about: str) -> str:
    """The page in Markdown; `about` says what was run, and how."""
    poses, loads = poses_of(results), loads_of(results)
    faults = sum(bool(result["faults"]) for result in results)
    parts = [
        "# Does the paper's claim hold in physics?",
        about,
        IN_SHORT,
        in_short(results),
        "## Hands that keep hold of the tool and reach half and nine tenths of their planned range",
        f"{len(results)} hands with a kinematic tool motion range greater than zero in all poses; "
        f"{faults} of them have a pose for which no trajectory or no grip could be made, which counts "
        "as not held.",
        _table(
            ["load", "pose", "held to the end", "never tipped", "reached 50 %", "reached 90 %", "median share"],
            [_row(results, load, pose) for load in loads for pose in [*poses, "all"]],
        ),
        "`never tipped`: held to the end, the tool's axis never "
        f"{TIPPED_DEG:g} degrees or more out of its planned motion. "
        "`reached` counts hands that held the tool to the end *and* passed that share of their planned "
        "range before it tipped; the median is over all hands, what a hand turned before it lost the tool "
        "included. `all` asks it of every pose of a hand. In brackets: 95 % intervals (Wilson).",
        "## Which figure predicts it?",
        "Spearman's rank correlation over hands between a figure of the path and the share of the "
        "planned range that was reached before the tool tipped (0 where it was lost). `metric`: what "
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


def _row(results: Sequence[Result], load: str, pose: str) -> list[str]:
    median = float(np.median([score.share for score in scores(results, load, pose)]))
    counts = [_share(count, len(results)) for count in reached_counts(results, load, pose)]
    return [load, pose, *counts, f"{median:.2f}"]


def _share(count: int, n: int) -> str:
    """Percentage with its Wilson interval."""
    z, p = 1.959964, count / n
    centre = (p + z * z / (2 * n)) / (1 + z * z / n)
    half = z * np.sqrt(p * (1 - p) / n + z * z / (4 * n * n)) / (1 + z * z / n)
    low, high = max(0.0, centre - half), min(1.0, centre + half)
    return f"{p:.0%} ({count}) [{low:.0%}, {high:.0%}]"


def _rank(results: Sequence[Result], load: str, pose: str, kind: str, name: str) -> str:
    found = rank_correlation(results, load, pose, kind, name)
    return "-" if found is None else f"{found:+.2f}"


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)
