"""What a build folder tells of the hand that was made: parts list, checks, refusals, torques."""

from __future__ import annotations

import csv
from collections import Counter
from pathlib import Path

from fpcad.look.run import Run
from fpcad.select.columns import flags

Row = dict[str, str]

BOM, CHECKS = Path("parts") / "bom.csv", Path("parts") / "checks.csv"
LOADS = Path("parts") / "loads.csv"
SEVERITIES = ("error", "warning", "figure")
FIGURES = ("value", "limit")
STAMP = ("hand", "spec_sha256")
"""Columns that tell whose file it is: the page says so once."""
UNITS = {"_g": "g", "_cm3": "cm³", "_mm": "mm"}
SHOWN_REFUSALS = 10
MOST_WARNINGS = 2
SHOWN_LOADS = 30
"""Of the checks at the top of the page; more of them would hide what it is about."""


def parts_list(run: Run) -> list[Row]:
    """Rows of parts/bom.csv without columns that are empty in all of them, units in brackets.

    None before the export is done.
    """
    rows = _rows(run, BOM)
    filled = [
        name
        for name in (rows[0] if rows else ())
        if name not in STAMP and any(row[name] for row in rows)
    ]
    return [{_heading(name): row[name] or "" for name in filled} for row in rows]


def _heading(name: str) -> str:
    unit = next((unit for suffix, unit in UNITS.items() if name.endswith(suffix)), "")
    words = name.rsplit("_", 1)[0] if unit else name
    return words.replace("_", " ") + (f" [{unit}]" if unit else "")


def checks(run: Run) -> list[Row]:
    """Findings of parts/checks.csv, the gravest first; none before the export is done."""
    rank = {severity: k for k, severity in enumerate(SEVERITIES)}
    found = [
        {**row, **{name: _short(row.get(name, "")) for name in FIGURES}}
        for row in _rows(run, CHECKS)
    ]
    return sorted(found, key=lambda row: rank.get(row.get("severity", ""), len(rank)))


def loads(run: Run) -> list[Row]:
    """What motors, tendons, bearings and bones bear, of parts/loads.csv, the heaviest share first."""
    return sorted(_rows(run, LOADS), key=lambda row: -float(row["share"]))


def _short(number: str) -> str:
    """A number with four digits; what is none stays as it is."""
    try:
        return f"{float(number):.4g}"
    except ValueError:
        return number


def check_warnings(run: Run) -> list[str]:
    """What the gates warn of: a sentence each, or one for all where they are more than two."""
    found = [
        f"{row.get('part', '')}: {row.get('text', '')}"
        for row in checks(run)
        if row.get("severity") in SEVERITIES[:2]
    ]
    if len(found) <= MOST_WARNINGS:
        return [f"{text}." for text in found]
    return [f"The checks of the chosen hand warn {len(found)} times; the first: {found[0]}."]


def load_warnings(run: Run) -> list[str]:
    """What bears more than it may along the trajectories: how many, and the worst."""
    over = [row for row in loads(run) if float(row["share"]) > 1.0]
    if not over:
        return []
    worst = over[0]
    return [
        f"In {len(over)} place{'s' * (len(over) > 1)} the hand bears more than it may; the worst: {worst['where']}, "
        f"{worst['what']} of {worst['load']} {worst['unit']} in {worst['pose']} ({worst['case']}), "
        f"{worst['limit']} {worst['unit']} are allowed."
    ]


def torque_warnings(run: Run) -> list[str]:
    """Whether the chosen hand's motors hold the tip force that the spec asks for."""
    chosen = run.selected or {}
    weak = [
        f"{pose['held_tip_force_n']:.1f} N of {pose['tip_force_n']:g} N in {name}"
        for name, pose in chosen.get("torque", {}).items()
        if pose["held_tip_force_n"] < pose["tip_force_n"]
    ]
    return (
        [f"{chosen['motor']} motors hold less at the tip than asked: {', '.join(weak)}."]
        if weak
        else []
    )


def refusals(run: Run) -> list[tuple[str, int, list[int]]]:
    """Reasons why hands cannot be made, each with how many and the first of them.

    The most frequent first; at most ten, and the rest as one.
    """
    table = run.metrics
    if not table.num_rows:
        return []
    refused = [
        (reason or "no reason was told", int(candidate))
        for makeable, reason, candidate in zip(
            flags(table, "makeable"),
            table["reason"].to_pylist(),
            table["id"].to_pylist(),
            strict=True,
        )
        if not makeable
    ]
    counts = Counter(reason for reason, _ in refused).most_common()
    shown = [
        (reason, count, [i for told, i in refused if told == reason][:5])
        for reason, count in counts[:SHOWN_REFUSALS]
    ]
    rest = sum(count for _, count in counts[SHOWN_REFUSALS:])
    return [*shown, (f"{len(counts) - SHOWN_REFUSALS} more reasons", rest, [])] if rest else shown


def _rows(run: Run, name: Path) -> list[Row]:
    file = run.folder / name
    exported = run.manifest["stages"].get("export", {}).get("status") == "done"
    if not exported or not file.exists():
        return []
    with file.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))
