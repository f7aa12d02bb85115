"""The command of benchmarks/recheck.py, and the re-check as a piece of a document."""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from benchmarks.paper.markdown import table
from benchmarks.paper.recheck import LIMITS, Recheck, recheck
from benchmarks.paper.recheck_ipopt import (
    ABSOLUTE,
    RELATIVE,
    SETTINGS,
    PoseComparison,
    compare_with_ipopt,
)
from fpcad.commands.console import ConsoleReporter
from fpcad.pipeline.stage import Build
from fpcad.spec.load import load_spec
from fpcad.workers import available_cores

HANDS, IPOPT_HANDS = 1000, 100


def main() -> None:
    """Print both tables; exit code 1 where a pose is out of its tolerance."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=Path, help="a build folder, as build/paper-6d")
    parser.add_argument("--hands", type=int, default=HANDS)
    parser.add_argument("--ipopt", type=int, default=IPOPT_HANDS, help="hands given to IPOPT")
    parser.add_argument("--workers", type=int, default=available_cores())
    told = parser.parse_args()
    spec = load_spec(told.build / "spec.yaml")
    build = Build(spec, told.build, told.workers, reporter=ConsoleReporter())
    checked = recheck(told.build, told.hands)
    print(residual_section(checked), end="\n\n")
    print(ipopt_section(compare_with_ipopt(build, told.ipopt)))
    if not checked.all_within:
        raise SystemExit(1)


def residual_section(checked: Recheck) -> str:
    """The independent measures in words and a table."""
    rows = [
        (limit.meaning, f"{checked.worst[name]:.1e}", f"{limit.most:.7g}", _of(checked, name))
        for name, limit in LIMITS.items()
    ]
    return "\n\n".join(
        [
            f"{checked.hands:,} random candidates, {checked.poses:,} poses, judged by "
            "`benchmarks/paper/plain_hand.py`: kinematics, surfaces, collision pairs, friction cones and "
            "bounds written a second time in NumPy from the documents, equilibria by HiGHS.",
            table(("measure", "worst", "allowed", "poses within"), rows),
            f"The two nearest candidates of the build are {checked.spacing:.6f} times the prescribed "
            "distance apart.",
        ]
    )


def ipopt_section(compared: dict[str, PoseComparison]) -> str:
    """Costs beside IPOPT's in words and a table."""
    asked = max(comparison.asked for comparison in compared.values())
    return "\n\n".join(
        [
            f"{asked:,} random candidates solved again by IPOPT with exact Hessians from the stored "
            f"states. A cost is no worse if it is within {RELATIVE:.0%} of IPOPT's or {ABSOLUTE:g}, "
            "whichever is larger. IPOPT may end elsewhere: both signs occur. Where none of its "
            f"{len(SETTINGS)} settings ends in an acceptable state, it counts as unsolved; the stored state is "
            "judged above.",
            table(
                (
                    "pose",
                    "solved by IPOPT",
                    "ours no worse",
                    "IPOPT's worse",
                    "median cost, ours",
                    "IPOPT's",
                    "ours - IPOPT's: median",
                    "95 %",
                    "largest",
                ),
                [_comparison_row(pose, c) for pose, c in compared.items()],
            ),
        ]
    )


def _of(checked: Recheck, name: str) -> str:
    return f"{checked.within[name]:,} of {checked.poses:,}"


def _comparison_row(pose: str, c: PoseComparison) -> tuple[str, ...]:
    solved = len(c.ours)
    if not solved:
        return (pose, f"0 of {c.asked}", *["-"] * 7)
    figures = (
        np.median(c.ours),
        np.median(c.ipopt),
        *np.quantile(c.excess, (0.5, 0.95, 1.0)),
    )
    counts = (f"{solved} of {c.asked}", f"{c.no_worse} of {solved}", f"{c.better} of {solved}")
    return (pose, *counts, *(f"{value:.1e}" for value in figures))
