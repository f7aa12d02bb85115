"""Does the paper's claim hold in physics? Runs hands of a build in MuJoCo and writes what came out.

.venv/bin/python -m benchmarks.physics_hypothesis designs/clay.yaml --hands 200
"""

from __future__ import annotations

import argparse
from pathlib import Path

from benchmarks.physics_hypothesis.report import page
from benchmarks.physics_hypothesis.run import run
from benchmarks.physics_hypothesis.scores import read_results
from benchmarks.physics_hypothesis.summary import with_physics
from fpcad.commands.console import ConsoleReporter
from fpcad.pipeline.run import run_stages
from fpcad.pipeline.stage import Build
from fpcad.simulate.setting import TIME_STEP_S
from fpcad.spec.load import load_spec
from fpcad.spec.schema import Spec
from fpcad.store import write_whole

SPARE = 1.15
"""How many more hands are sampled than tried: some do not wield in all poses."""


def main() -> None:
    """Sample hands, try them, and write the results' tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("spec", type=Path)
    parser.add_argument("--hands", type=int, default=200)
    parser.add_argument("--build", type=Path, default=Path("build/physics"))
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--time-step-ms", type=float, default=1000.0 * TIME_STEP_S)
    parser.add_argument("--page", type=Path, default=Path("docs/physics-hypothesis.md"))
    parser.add_argument("--results", type=Path, default=Path("docs/results.md"))
    parser.add_argument(
        "--tables-only", action="store_true", help="write what is there, try no hand"
    )
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    spec = load_spec(asked.spec)
    sampling = spec.sampling.model_copy(update={"candidates": round(SPARE * asked.hands)})
    spec = spec.model_copy(update={"sampling": sampling})
    trials = asked.build / "trials"
    if not asked.tables_only:
        build = Build(spec, asked.build / spec.name, asked.workers, ConsoleReporter())
        run_stages(build, "evaluate")
        run(build, asked.hands, trials, asked.time_step_ms / 1000.0, asked.seed)
    results = read_results(trials)
    written = page(results, about(spec, asked, len(results)))
    write_whole(asked.page, written)
    document = asked.results.read_text(encoding="utf-8")
    write_whole(asked.results, with_physics(document, written))


def about(spec: Spec, asked: argparse.Namespace, done: int) -> str:
    """What was run, in words."""
    radii = ", ".join(f"{k} {v:g}" for k, v in spec.motors.transmission.model_dump().items())
    grip = ", ".join(f"{k} {v}" for k, v in spec.grip.model_dump(exclude_none=True).items())
    unfinished = f"**Unfinished: {done} of {asked.hands} hands, in the order drawn.** "
    return (unfinished if done < asked.hands else "") + (
        f"Written by `python -m benchmarks.physics_hypothesis {asked.spec} --hands {asked.hands}`: "
        f"hands drawn with seed {asked.seed} from {spec.sampling.candidates} candidates, each pose's "
        f"exported trajectory in MuJoCo in the open loop, steps of {asked.time_step_ms:g} ms. Links are "
        f"capsules of even density; docs/physics.md tells the rest.\n\n"
        f"Motors {spec.motors.type}; {radii}. Grip: {grip}."
    )


if __name__ == "__main__":
    main()
