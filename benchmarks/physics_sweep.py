"""What the physics of a finished hand hangs on: friction, the simulation's steps, the tendons' stiffness.

    python -m benchmarks.physics_sweep clay

Writes a table in Markdown: the share of the planned range that the tool of 20 g passes before it tips,
unloaded and with 1 N at its tip; what is dropped or tips after that is told.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from pathlib import Path

from fpcad.make.gripping import gripping_trajectory
from fpcad.make.trajectory import Trajectory
from fpcad.model.geometry import hand_geometry
from fpcad.pipeline.finished import chosen_design
from fpcad.pipeline.paths import read_paths
from fpcad.pipeline.select import SELECTED
from fpcad.pipeline.stage import Build
from fpcad.simulate.measure import Outcome
from fpcad.simulate.scene import hand_spec
from fpcad.simulate.setting import Trial
from fpcad.simulate.trials import LIGHT_KG, judge, run_trial
from fpcad.spec.load import load_spec
from fpcad.spec.schema import Spec
from fpcad.store import read_json

FRICTIONS = (0.4, 0.6, 0.8, 1.0, 1.2)
STEPS_MS = (1.0, 0.5, 0.25)
TENDONS_MM = (250.0, 185.0, 150.0, 92.0)
TIP_FORCES_N = (0.0, 1.0)
LIGHT = Trial(LIGHT_KG)


class FinishedHand:
    """The hand that was chosen in a build."""

    def __init__(self, folder: Path) -> None:
        self.spec = load_spec(folder / "spec.yaml")
        self._folder, self._build = folder, Build(self.spec, folder)

    @cached_property
    def trajectories(self) -> dict[str, Trajectory]:
        """By pose, as the spec asks for them."""
        return self.gripping(self.spec)

    def gripping(self, spec: Spec) -> dict[str, Trajectory]:
        """Trajectories by pose along its paths, with the grip of another spec."""
        chosen = int(read_json(self._folder / SELECTED)["id"])
        design, bench = chosen_design(spec, self._folder), replace(self._build.bench, spec=spec)
        geometry = hand_geometry(bench.template, design)
        return {
            pose: gripping_trajectory(bench, design, geometry, path)[0]
            for pose, path in read_paths(self._build, chosen).items()
        }

    def row(
        self, spec: Spec, trajectories: dict[str, Trajectory], changed: Trial = LIGHT
    ) -> list[str]:
        """A cell for each pose."""
        hand = hand_spec(self._folder / "hand" / "mjcf" / f"{self.spec.name}.xml")
        cells = []
        for pose, trajectory in trajectories.items():
            trials = [replace(changed, tip_force_n=force) for force in TIP_FORCES_N]
            records = [run_trial(hand, spec, pose, trajectory, trial) for trial in trials]
            told = [cell(judge(spec, pose, trajectory, record)) for record in records]
            cells.append(" / ".join(told))
        return cells


def sweep(hand: FinishedHand) -> Iterator[list[str]]:
    """Rows of the table, one change each."""
    spec = hand.spec
    for friction in FRICTIONS:
        yield [
            f"friction {friction:g}",
            *hand.row(spec, hand.trajectories, replace(LIGHT, friction=friction)),
        ]
    for step in STEPS_MS:
        stepped = replace(LIGHT, time_step_s=step / 1000.0)
        yield [f"steps of {step:g} ms", *hand.row(spec, hand.trajectories, stepped)]
    for length in TENDONS_MM:
        grip = spec.grip.model_copy(update={"tendon_length_mm": length})
        softer = spec.model_copy(update={"grip": grip})
        yield [f"tendons of {length:g} mm", *hand.row(softer, hand.gripping(softer))]


def cell(outcome: Outcome) -> str:
    """The share, and what happened after it."""
    after = "" if outcome.tipped_at_s is None else " tips"
    return f"{outcome.reached_share:.2f}{after if outcome.held else ' lost'}"


def main() -> None:
    """Print the table row by row."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("name")
    parser.add_argument("--build", type=Path, default=Path("build"))
    asked = parser.parse_args()
    hand = FinishedHand(asked.build / asked.name)
    head = ["", *hand.spec.poses]
    for row in (head, ["---"] * len(head), *sweep(hand)):
        print(f"| {' | '.join(row)} |", flush=True)


if __name__ == "__main__":
    main()
