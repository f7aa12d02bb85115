"""Does the paper's claim hold in physics? Runs hands of a build in MuJoCo and writes what came out.

.venv/bin/python -m benchmarks.physics_hypothesis designs/clay.yaml --hands 200
"""

from __future__ import annotations

import argparse
from pathlib import Path

from fpcad.commands.console import ConsoleReporter
from fpcad.pipeline.run import run_stages
from fpcad.pipeline.stage import Build
from fpcad.spec.load import load_spec

SPARE = 1.15
"""How many more hands are sampled than tried: some do not wield in all poses."""


def main() -> None:
    """Sample hands, try them, and write the results' tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("spec", type=Path)
    parser.add_argument("--hands", type=int, default=200)
    parser.add_argument("--build", type=Path, default=Path("build/physics"))
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--time-step-ms", type=float, default=1.0)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    spec = load_spec(asked.spec)
    sampling = spec.sampling.model_copy(update={"candidates": round(SPARE * asked.hands)})
    spec = spec.model_copy(update={"sampling": sampling})
    build = Build(spec, asked.build / spec.name, asked.workers, ConsoleReporter())
    run_stages(build, "evaluate")
    from benchmarks.physics_hypothesis.run import run

    results = asked.build / "trials"
    run(build, asked.hands, results, asked.time_step_ms / 1000.0, asked.seed)


if __name__ == "__main__":
    main()
