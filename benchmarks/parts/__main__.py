"""Make so many hands of a spec's box and write what became of them as a table.

nice .venv/bin/python -m benchmarks.parts clay --count 200 --out docs/parts-of-hands.md

Each hand is made in a process of its own, and what became of it is kept: a run that was stopped goes on.
"""

from __future__ import annotations

import argparse
import json
from collections import Counter
from dataclasses import asdict
from pathlib import Path

import numpy as np

from benchmarks.parts.candidates import Outcome, attempt_apart, designs, kind_of
from fpcad.spec.load import load_spec
from fpcad.store import read_json, write_json, write_whole


def report(outcomes: list[Outcome], name: str, seed: int) -> str:
    """The table, in Markdown."""
    verdicts = Counter(outcome.verdict for outcome in outcomes)
    made = [o.seconds for o in outcomes if o.verdict == "made"]
    slow = np.quantile(made, [0.5, 0.9, 1.0]) if made else np.full(3, np.nan)
    lines = [
        f"# What becomes of {len(outcomes)} hands of {name}'s box",
        "",
        f"The box's corners that are possible at all, then random designs (seed {seed}). Each is made as solids and",
        "put through all gates but those that need trajectories, and the reach, which refuses nothing.",
        f"`python -m benchmarks.parts {name}` makes this page.",
        "",
        "| | hands | share |",
        "|---|---|---|",
    ]
    for verdict in ("made", "refused early", "refused", "crashed"):
        share = 100 * verdicts[verdict] / len(outcomes)
        lines.append(f"| {verdict} | {verdicts[verdict]} | {share:.1f} % |")
    lines += [
        "",
        "Processor seconds for a hand that is made, solids and gates: median {:.1f}, 90th percentile {:.1f}, "
        "longest {:.1f}.".format(*slow),
        "",
        "| refused because | hands |",
        "|---|---|",
    ]
    reasons = Counter(kind_of(o.reason) for o in outcomes if o.reason)
    lines += [f"| {reason} | {number} |" for reason, number in reasons.most_common()]
    return "\n".join(lines) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("name")
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kept", type=Path, default=Path("build/parts-of-hands"))
    parser.add_argument("--out", type=Path, default=Path("build/parts-of-hands.md"))
    asked = parser.parse_args()
    spec = load_spec(Path("designs") / f"{asked.name}.yaml")
    outcomes = []
    for number, named in enumerate(designs(spec, asked.count, asked.seed, corners=True), start=1):
        kept = asked.kept / f"{number}.json"
        if not kept.is_file():
            write_json(kept, asdict(attempt_apart(spec, named)))
        outcomes.append(Outcome(**read_json(kept)))
        print(number, json.dumps(asdict(outcomes[-1])), flush=True)
        write_whole(asked.out, report(outcomes, asked.name, asked.seed))


if __name__ == "__main__":
    main()
