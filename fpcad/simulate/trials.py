"""The trials that every pose of a hand goes through, and how one is run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from fpcad.errors import MakeError
from fpcad.make.trajectory import Trajectory
from fpcad.simulate.command import commands
from fpcad.simulate.measure import Outcome, outcome
from fpcad.simulate.roll import Record, roll
from fpcad.simulate.scene import Scene, build_scene
from fpcad.simulate.setting import Trial
from fpcad.spec.catalogue import motor
from fpcad.spec.schema import Spec

LIGHT_KG, HEAVY_KG = 0.02, 0.1
"""Masses of the tools that are tried: a stylus and a steel tool."""


@dataclass(frozen=True)
class Tried:
    """A trial with what was seen of it."""

    name: str
    trial: Trial
    record: Record
    outcome: Outcome


def standard_trials(spec: Spec, pose: str, held_tip_force_n: float) -> dict[str, Trial]:
    """Trials by name: both tools without load, then forces at the tip of the light one.

    Args:
        spec: whose pose asks for a tip force, which is tried without the motors' limits.
        pose: the pose that is tried.
        held_tip_force_n: largest tip force that the motors hold along the path [N].
    """
    asked = spec.poses[pose].tip_force_n
    return {
        "unloaded, 20 g": Trial(LIGHT_KG),
        "unloaded, 100 g": Trial(HEAVY_KG),
        "1 N": Trial(LIGHT_KG, 1.0),
        "half of held": Trial(LIGHT_KG, held_tip_force_n / 2),
        f"{asked:g} N, motors without limits": Trial(LIGHT_KG, asked, limited=False),
    }


def run_trial(hand: Any, spec: Spec, pose: str, trajectory: Trajectory, trial: Trial) -> Record:
    """Run one trial of a pose.

    Args:
        hand: MuJoCo's editable form of the hand; it stays as it is.
        spec: the design.
        pose: whose turning is tried.
        trajectory: what is run, with its grip preload.
        trial: what is tried.
    """
    if trajectory.position_preload_rad is None:
        raise MakeError(f"{pose}: the trajectory has no grip preload; run `fpcad export` again")
    scene = build_scene(hand.copy(), spec, trajectory, trial)
    return roll(scene, commands(trajectory, scene.A, trial), trajectory.position_rad[0])


def judge(spec: Spec, pose: str, trajectory: Trajectory, record: Record) -> Outcome:
    """The figures of a record."""
    limit = motor(spec.motors.type).continuous_torque_nm
    return outcome(record, trajectory, spec.poses[pose].turning, limit)


def scene_of(hand: Any, spec: Spec, trajectory: Trajectory, trial: Trial) -> Scene:
    """The scene of a trial, for those who want to look at it."""
    return build_scene(hand.copy(), spec, trajectory, trial)
