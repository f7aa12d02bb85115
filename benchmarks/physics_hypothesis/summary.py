"""What the trials say in a few sentences, for the page and for docs/results.md."""

from __future__ import annotations

from collections.abc import Sequence

from benchmarks.physics_hypothesis.scores import (
    KINEMATIC,
    Result,
    loads_of,
    poses_of,
    rank_correlation,
    reached_counts,
)
from fpcad.simulate.measure import TIPPED_DEG

IN_SHORT = "## In short"
IN_RESULTS = "## In physics"
ABOUT = (
    "Whether hands that move the tool on paper turn it in a simulation with friction, weight and soft "
    "tendons, in the open loop; [physics.md](physics.md) and [physics-hypothesis.md](physics-hypothesis.md) "
    "have it all."
)


def in_short(results: Sequence[Result]) -> str:
    """Two lists: hands by load, and for each pose the metric that orders hands most like physics."""
    lines = [
        f"Of {len(results)} hands whose kinematic tool motion range is greater than zero in all poses, keep "
        f"hold of the tool in all poses, never let it tip by {TIPPED_DEG:g} degrees out of its planned motion, "
        "and hold it and pass half, and nine tenths, of the planned range before it tips, in all of them:",
        "\n".join(_by_load(results, load) for load in loads_of(results)),
        "The metric of the search whose rank correlation with the range that is reached before the tool "
        "tips is largest:",
        "\n".join(_best_metric(results, load) for load in loads_of(results)[:3]),
    ]
    return "\n\n".join(lines)


def _by_load(results: Sequence[Result], load: str) -> str:
    held, wielded, half, most = reached_counts(results, load, "all")
    return f"- {load}: {held} hold, {wielded} never tip, {half} pass half, {most} nine tenths"


def _best_metric(results: Sequence[Result], load: str) -> str:
    told = []
    for pose in poses_of(results):
        found = {name: rank_correlation(results, load, pose, "metrics", name) for name in KINEMATIC}
        known = {name: value for name, value in found.items() if value is not None}
        if known:
            best = max(known, key=lambda name: abs(known[name]))
            told.append(f"{pose} `{best}` {known[best]:+.2f}")
    return f"- {load}: {', '.join(told) or 'none, for all hands did the same'}"


def section(page: str) -> str:
    """The summary in a page that was written."""
    return page.split(f"{IN_SHORT}\n\n", 1)[1].split("\n\n## ", 1)[0]


def physics_section(page: str) -> str:
    """What docs/results.md says of physics, from the page about it."""
    return f"{ABOUT}\n\n{section(page)}"


def with_physics(document: str, page: str) -> str:
    """docs/results.md with its last section written anew."""
    before = document.split(f"{IN_RESULTS}\n\n", 1)[0]
    return f"{before}{IN_RESULTS}\n\n{physics_section(page)}\n"
