"""A candidate in physics before any part of it is made: plain bodies, and a few trials a pose."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray

from fpcad.errors import MakeError
from fpcad.make.description import LinkBody, describe
from fpcad.make.description.mjcf import hand_mjcf
from fpcad.make.gripping import gripping_trajectory
from fpcad.make.inertia import inertia_of
from fpcad.make.preload.margins import Margins
from fpcad.make.trajectory import Trajectory
from fpcad.model.geometry import HandGeometry, hand_geometry
from fpcad.simulate.engine import mujoco
from fpcad.simulate.setting import Trial
from fpcad.simulate.trials import LIGHT_KG, judge, run_trial
from fpcad.solve.attempt import Workbench
from fpcad.spec.schema import Spec
from fpcad.wield.path import WieldingPath

Array = NDArray[np.float64]

DENSITY_G_CM3 = 0.7
"""Mean density of finger capsules, which gives clay's first hand the masses of its CAD parts."""
MCP_RADIUS_MM = 5.0
TRIALS = {"held_share": Trial(LIGHT_KG), "held_share_1n": Trial(LIGHT_KG, 1.0)}
"""Trials that a candidate is judged by, by the column that tells their outcome."""


def held_shares(
    bench: Workbench, design: Array, paths: Mapping[str, WieldingPath]
) -> tuple[dict[str, dict[str, float]], dict[str, str]]:
    """What a hand does with its tool, and by pose what kept it from being tried.

    Args:
        bench: formulas of the spec's poses.
        design: (n_d,) [mm, rad].
        paths: the hand's path in each pose.

    Returns:
        For each pose and each of `TRIALS`, the share [-] of the planned range that the tool passes
        before it tips in a hand that keeps hold of it to the end; 0 where the hand drops it or could not be tried.
    """
    spec, geometry = bench.spec, hand_geometry(bench.template, design)
    made, faults = trajectories(bench, design, geometry, paths)
    hand = plain_hand(spec, geometry, {pose: moving for pose, (moving, _) in made.items()})
    shares = {pose: dict.fromkeys(TRIALS, 0.0) for pose in spec.poses}
    for pose, (trajectory, _) in made.items():
        for column, trial in TRIALS.items():
            try:
                record = run_trial(hand, spec, pose, trajectory, trial)
            except MakeError as error:
                faults[pose] = str(error)
                continue
            told = judge(spec, pose, trajectory, record)
            shares[pose][column] = told.reached_share if told.held else 0.0
    return shares, faults


def trajectories(
    bench: Workbench, design: Array, geometry: HandGeometry, paths: Mapping[str, WieldingPath]
) -> tuple[dict[str, tuple[Trajectory, Margins]], dict[str, str]]:
    """Trajectories by pose, and by pose why there is none."""
    made, faults = {}, {}
    for pose, path in paths.items():
        try:
            made[pose] = gripping_trajectory(bench, design, geometry, path)
        except MakeError as error:
            faults[pose] = str(error)
    return made, faults


def plain_hand(spec: Spec, geometry: HandGeometry, moving: Mapping[str, Trajectory]) -> Any:
    """MuJoCo's editable form of a hand with plain bodies."""
    xml = hand_mjcf(describe(spec, geometry, plain_bodies(geometry), moving))
    return mujoco().MjSpec.from_string(xml)


def plain_bodies(geometry: HandGeometry) -> dict[str, LinkBody]:
    """Links as capsules of even density; modelling each hand's parts would take ten seconds."""
    distal_axis = geometry.distal_length_mm - geometry.radius_mm
    shapes = {
        "palm": trimesh.creation.icosphere(radius=20.0),
        "mcp": trimesh.creation.icosphere(radius=MCP_RADIUS_MM),
        "proximal": _capsule(geometry.proximal_length_mm, geometry.radius_mm),
        "distal": _capsule(distal_axis, geometry.radius_mm),
    }
    return {
        link: LinkBody(inertia_of([(shape, DENSITY_G_CM3)]), ()) for link, shape in shapes.items()
    }


def _capsule(length: float, radius: float) -> trimesh.Trimesh:
    """A capsule from the origin along x [mm]."""
    capsule = trimesh.creation.capsule(height=length, radius=radius)
    turn = trimesh.transformations.rotation_matrix(np.pi / 2, [0.0, 1.0, 0.0])
    return capsule.apply_transform(turn)
