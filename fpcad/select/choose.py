"""Choosing one hand of a ranked table by a rule that the spec names, and saying why."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from fpcad.errors import SolveError
from fpcad.select.columns import flags, numbers
from fpcad.select.ranking import PARETO
from fpcad.select.scores import MEAN_SCORE

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

MERIT_DECIMALS = 9  # means of equal scores summed in another order differ in their last bits
SHARE_DECIMALS = 2  # a hundredth of the planned range more or less says nothing


@dataclass(frozen=True)
class Choice:
    """The chosen hand."""

    id: int
    """Its `id` in the table."""
    rule: str
    """Rule that chose it."""
    reason: str
    """Why, in a sentence with numbers."""
    scores: dict[str, float]
    """All of its scores by column, `mean_score` too, from 0 to 100."""


class Criterion(NamedTuple):
    """What a rule asks of the hands of a table."""

    eligible: Mask  # (n,)
    merit: Array  # (n,) the largest wins
    merit_name: str
    group: str  # what the eligible hands are called


Rule = Callable[[pa.Table], Criterion]


def best_mean_on_front(table: pa.Table) -> Criterion:
    """Best mean score among the hands on the Pareto front."""
    front = flags(table, PARETO)
    return Criterion(front, numbers(table, MEAN_SCORE), "mean score", "on the Pareto front")


def best_mean(table: pa.Table) -> Criterion:
    """Best mean score among all hands."""
    return Criterion(_all(table), numbers(table, MEAN_SCORE), "mean score", "that can be made")


def best_worst_score(table: pa.Table) -> Criterion:
    """Best lowest score: the hand whose weakest point is the least weak."""
    lowest = np.min([numbers(table, name) for name in single_scores(table)], axis=0)
    return Criterion(_all(table), lowest, "lowest score", "that can be made")


RULES: dict[str, Rule] = {
    "best_mean_on_front": best_mean_on_front,
    "best_mean": best_mean,
    "best_worst_score": best_worst_score,
}


def finalists(table: pa.Table, rule: str, count: int) -> list[int]:
    """Ids of the best hands that can be made, at most `count`, the best first."""
    criterion = RULES[rule](table)
    rows = np.flatnonzero(criterion.eligible & flags(table, "makeable"))
    ids = table["id"].to_numpy()
    order = np.lexsort((ids[rows], -np.round(criterion.merit[rows], MERIT_DECIMALS)))
    return ids[rows[order[:count]]].tolist()


def choose(table: pa.Table, rule: str, shares: Sequence[str] = ()) -> Choice:
    """The best hand that can be made; of equal ones the one with the lowest id.

    Hands that were tried in physics come before all others. Of these the one wins whose worst trial
    went best, then the one that did best in the mean, then the one that the rule prefers.

    Args:
        table: n rows as :func:`fpcad.select.ranking.rank_table` gives them.
        rule: a key of `RULES`.
        shares: columns that tell, for each trial in physics, the share of the planned range that
            was reached; empty where a hand was not tried.
    """
    makeable = flags(table, "makeable")
    if not makeable.any():
        raise SolveError(_why_none(table))
    criterion = RULES[rule](table)
    selectable = criterion.eligible & makeable
    if not selectable.any():
        raise SolveError(
            f"none of the hands {criterion.group} can be made, of {_hands(table.num_rows)}"
        )
    reached = np.array([numbers(table, column) for column in shares])  # (k, n)
    tried = selectable & np.isfinite(reached).all(axis=0) if shares else np.zeros_like(selectable)
    if tried.any():
        worst, mean = reached.min(axis=0), reached.mean(axis=0)
        merits = [np.round(worst, SHARE_DECIMALS), np.round(mean, SHARE_DECIMALS), criterion.merit]
        row = _best_row(table, merits, tried)
        reason = _reason_tried(table, criterion, tried, worst[row], mean[row])
    else:
        row = _best_row(table, [criterion.merit], selectable)
        reason = _reason(table, criterion, selectable, row)
    return Choice(
        id=table["id"][row].as_py(),
        rule=rule,
        reason=reason,
        scores={name: table[name][row].as_py() for name in [*single_scores(table), MEAN_SCORE]},
    )


def single_scores(table: pa.Table) -> list[str]:
    """Names of the score columns of a table, without the mean."""
    return [n for n in table.column_names if n.endswith("_score") and n != MEAN_SCORE]


def _all(table: pa.Table) -> Mask:
    return np.ones(table.num_rows, dtype=bool)


def _best_row(table: pa.Table, merits: Sequence[Array], selectable: Mask) -> int:
    """The row that is best by the first merit, of equal ones by the next, and last by its id."""
    best = selectable
    for merit in merits:
        rounded = np.round(merit, MERIT_DECIMALS)
        best = best & (rounded == rounded[best].max())
    rows = np.flatnonzero(best)
    return int(rows[np.argmin(table["id"].to_numpy()[rows])])


def _reason(table: pa.Table, criterion: Criterion, selectable: Mask, row: int) -> str:
    return (
        f"best {criterion.merit_name} ({criterion.merit[row]:.1f}) of "
        f"{_hands(int(selectable.sum()))} {criterion.group}; {_hands(table.num_rows)} in all, "
        f"{_refusals(int(np.sum(~flags(table, 'makeable'))))}"
    )


def _reason_tried(
    table: pa.Table, criterion: Criterion, tried: Mask, worst: float, mean: float
) -> str:
    return (
        f"turns the tool farthest in physics, by {worst:.0%} of the planned range in its worst trial "
        f"and {mean:.0%} in the mean; tried were {_hands(int(tried.sum()))}, those with the best "
        f"{criterion.merit_name} {criterion.group}; {_hands(table.num_rows)} in all, "
        f"{_refusals(int(np.sum(~flags(table, 'makeable'))))}"
    )


def _refusals(count: int) -> str:
    """Making is tried for the chosen hand alone, so of the others only refusals are known."""
    return "none refused so far" if count == 0 else f"{count} refused"


def _why_none(table: pa.Table) -> str:
    if table.num_rows == 0:
        return "no hand to choose from: the table of metrics is empty"
    reasons = Counter(reason or "no reason given" for reason in table["reason"].to_pylist())
    reason, count = max(reasons.items(), key=lambda item: (item[1], item[0]))
    share = "" if count == table.num_rows else f" ({count} of them)"
    return f"none of {_hands(table.num_rows)} can be made: {reason}{share}"


def _hands(count: int) -> str:
    return "1 hand" if count == 1 else f"{count} hands"
