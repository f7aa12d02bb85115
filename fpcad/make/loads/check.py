"""Findings of the loads: what is too much is a warning with figures, all else a figure."""

from __future__ import annotations

from collections.abc import Iterable

from fpcad.make.gates.finding import Finding, Severity
from fpcad.make.loads.cases import GRIPPING
from fpcad.make.loads.table import ANY, Load

Kind = tuple[str, str]
"""What is borne, and where on a finger."""

TITLE = "loads"
GATE = "load"
"""Loads warn and never refuse: a weaker hand is still a hand, and the tip force tells how weak."""


def load_findings(loads: Iterable[Load]) -> list[Finding]:
    """One finding for each kind of load, its worst pose and case; loads.csv has them all.

    What is too much at the most that motors do may be well below the limit while they only grip:
    that share is told beside it.
    """
    worst: dict[Kind, Load] = {}
    gripping: dict[Kind, float] = {}
    for load in loads:
        kind = load.what, load.where.split(" ", 1)[-1] if load.what in PER_FINGER else ""
        if kind not in worst or load.share > worst[kind].share:
            worst[kind] = load
        if load.case == GRIPPING:
            gripping[kind] = max(load.share, gripping.get(kind, 0.0))
    return [_finding(load, gripping.get(kind)) for kind, load in worst.items()]


PER_FINGER = ("strand", "bearing", "pin pressure", "pin bending", "bone", "cross")
"""Kinds of which each part of a finger has its own finding."""


def _finding(load: Load, gripping: float | None) -> Finding:
    severity = Severity.WARNING if load.share > 1 else Severity.FIGURE
    figures = load.load, load.limit, load.unit
    beside = ""
    if gripping is not None and load.case != GRIPPING:
        beside = f"; gripping alone {100 * gripping:.0f} %"
    return Finding(GATE, severity, load.where, *figures, text_of(load) + beside)


def text_of(load: Load) -> str:
    """A load in words for people."""
    can = "cannot" if load.share > 1 else "can"
    has, most = f"{load.load:.3g} {load.unit}", f"{load.limit:.3g} {load.unit}"
    if load.what == "tip force":
        return f"{can}: {has} are asked for at the tip {_when(load)}, {most} are held"
    if load.what == "slack":
        what = "hangs slack" if load.share > 1 else "stays taut"
        return f"its other strand {what}: {has} at the spool {_when(load)}, pretension serves up to {most}"
    if load.what == "motor torque":
        return f"{can}: needs {has} {_when(load)}, gives {most}"
    return f"{can}: {load.what} {has} {_when(load)}, limit {most} ({100 * load.share:.0f} %)"


def _when(load: Load) -> str:
    pose = "" if load.pose == ANY else f"in {load.pose}, "
    at = "" if load.at_deg is None else f", tool turned {load.at_deg:.0f} deg"
    return f"{pose}{load.case}{at}"
