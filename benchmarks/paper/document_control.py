"""The control group's table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from benchmarks.paper.markdown import interval, table

Row = Mapping[str, Any]

THRESHOLDS_DEG = (0, 10, 45)
HELD = {2: "both ways", 1: "one way", 0: "not"}
"""Words for the number of directions in which a pose is held."""
EXPLANATION = (
    "What does a foundational pose add? Four groups of random hands of the 6D experiment, all of whose poses satisfy "
    "every contact constraint, bound and clearance:\n\n"
    "- **candidates**: as sampled, for comparison;\n"
    "- **rejected by statics**: calls that reached all poses and are not held in at least one; solved once more "
    "from their parents' states;\n"
    "- **near / far from the optimum**: candidates whose poses were moved by a normal deviate (0.1 / 0.3; 1 is 10 mm "
    "and 1 rad) and brought back into contact on the shortest way, so that the cost plays no part.\n\n"
    "`held` says in which directions of turning the pose withstands the tip force; a candidate does in both. Each path is traced twice: "
    "ended by statics as usual, and with no force at the tip, where only kinematics ends it. Shares in per cent "
    "with exact 95 % binomial intervals. `all`: the least range of a hand's poses; there, `held` tells of its worst pose."
)


def control_section(control: Mapping[str, Sequence[Row]]) -> str:
    """Explanation and table."""
    headings = (
        "group",
        "held",
        "pose",
        "n",
        "moved, median",
        "cost, median",
        *(f"statics on: TMR > {t}" for t in THRESHOLDS_DEG),
        "median TMR [deg]",
        *(f"statics off: TMR > {t}" for t in THRESHOLDS_DEG),
        "median TMR [deg]",
    )
    rows = [row for group, hands in control.items() for row in group_rows(group, hands)]
    return "\n\n".join([EXPLANATION, table(headings, rows), reading(control)])


def group_rows(group: str, rows: Sequence[Row]) -> Iterator[tuple[str, ...]]:
    """Table rows of one group: each pose, then all poses; held ones first. Empty ones are left out."""
    poses = dict.fromkeys(row["pose"] for row in rows)
    everything = {pose: [row for row in rows if row["pose"] == pose] for pose in poses}
    everything["all"] = whole_hands(rows)
    for held, word in HELD.items():
        for pose, found in everything.items():
            kept = [row for row in found if row["held"] == held]
            if kept:
                yield (group, word, pose, str(len(kept)), *_figures(kept))


def whole_hands(rows: Sequence[Row]) -> list[Row]:
    """One row a hand: its least motion ranges, held as its worst pose is."""
    hands: dict[int, list[Row]] = {}
    for row in rows:
        hands.setdefault(row["hand"], []).append(row)
    return [_merged(poses) for poses in hands.values()]


def _merged(poses: Sequence[Row]) -> Row:
    return {
        "held": min(row["held"] for row in poses),
        "moved": float(np.sqrt(np.mean([row["moved"] ** 2 for row in poses]))),
        "cost": sum(row["cost"] for row in poses),
        "tmr_on_deg": min(row["tmr_on_deg"] for row in poses),
        "tmr_off_deg": min(row["tmr_off_deg"] for row in poses),
    }


def _figures(rows: Sequence[Row]) -> Iterator[str]:
    yield f"{np.median([row['moved'] for row in rows]):.2f}"
    yield f"{np.median([row['cost'] for row in rows]):.1e}"
    for column in ("tmr_on_deg", "tmr_off_deg"):
        values = np.array([row[column] for row in rows])
        for threshold in THRESHOLDS_DEG:
            yield interval(int((values > threshold).sum()), len(values))
        yield f"{np.median(values):.0f}"


def reading(control: Mapping[str, Sequence[Row]]) -> str:
    """What the table says, in sentences that are filled in from it."""
    lines = []
    for group, rows in control.items():
        for held, word in HELD.items():
            hands = [hand for hand in whole_hands(rows) if hand["held"] == held]
            if not hands:
                continue
            on, off = (sum(hand[c] > 0 for hand in hands) for c in ("tmr_on_deg", "tmr_off_deg"))
            lines.append(
                f"- {group}, held {word}: {on} of {len(hands)} hands move the tool in all poses with statics, "
                f"{off} without."
            )
    return "\n".join(lines)
