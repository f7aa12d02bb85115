"""A built hand's pose in physics: all trials, their figures, film and curves."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

from fpcad.make.trajectory_file import read_trajectory
from fpcad.simulate.hold import Hold, holds
from fpcad.simulate.picture import curves, film
from fpcad.simulate.scene import hand_spec
from fpcad.simulate.trials import Tried, judge, run_trial, scene_of, standard_trials
from fpcad.spec.schema import Spec
from fpcad.store import read_json, write_json

FOLDER = "simulation"

Progress = Callable[[str], None]


def simulate_pose(
    spec: Spec, build: Path, pose: str, friction: float | None, time_step_s: float, tell: Progress
) -> list[Tried]:
    """Run the standard trials of a pose from a build's files.

    Args:
        spec: the design.
        build: its build folder.
        pose: the pose that is tried.
        friction: coefficient of friction; the spec's where None.
        time_step_s: of the simulation.
        tell: is told each trial's name before it runs.
    """
    trajectory = read_trajectory(build / "trajectories" / f"{pose}.json")
    hand = hand_spec(build / "hand" / "mjcf" / f"{spec.name}.xml")
    held = read_json(build / "selected.json")["torque"][pose]["held_tip_force_n"]
    tried = []
    for name, trial in standard_trials(spec, pose, float(held)).items():
        tell(name)
        stepped = type(trial)(**{**asdict(trial), "friction": friction, "time_step_s": time_step_s})
        record = run_trial(hand, spec, pose, trajectory, stepped)
        tried.append(Tried(name, stepped, record, judge(spec, pose, trajectory, record)))
    return tried


def hold_pose(spec: Spec, build: Path, pose: str, tell: Progress) -> list[Hold]:
    """The static holds of a pose from a build's files."""
    trajectory = read_trajectory(build / "trajectories" / f"{pose}.json")
    hand = hand_spec(build / "hand" / "mjcf" / f"{spec.name}.xml")
    found = []
    for hold in holds(hand, spec, pose, trajectory):
        tell(f"gravity {hold.gravity}")
        found.append(hold)
    return found


def report_of(tried: list[Tried]) -> dict[str, Any]:
    """Trials and figures as plain values; equal runs give equal ones."""
    return {
        one.name: {"trial": asdict(one.trial), "outcome": one.outcome.as_values()} for one in tried
    }


def write_pose(
    spec: Spec, build: Path, pose: str, tried: list[Tried], with_film: bool
) -> list[Path]:
    """Write figures, curves and, if asked, the first trial's film of a pose; returns the files."""
    folder = build / FOLDER
    trajectory = read_trajectory(build / "trajectories" / f"{pose}.json")
    write_json(folder / f"{pose}.json", report_of(tried))
    turning = spec.poses[pose].turning
    files = [folder / f"{pose}.json", curves(tried, trajectory, turning, folder / f"{pose}.png")]
    if with_film:
        hand = hand_spec(build / "hand" / "mjcf" / f"{spec.name}.xml")
        scene = scene_of(hand, spec, trajectory, tried[0].trial)
        gif, sheet = folder / f"{pose}.gif", folder / f"{pose}-frames.png"
        files += film(scene, tried[0].record, trajectory, gif, sheet)
    return files
