"""Static hold: the tool at a pose, held still for ten seconds, gravity along every axis of the hand."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from fpcad.make.trajectory import ToolMotion, Trajectory
from fpcad.simulate.roll import Record
from fpcad.simulate.setting import Trial
from fpcad.simulate.trials import HEAVY_KG, LIGHT_KG, run_trial
from fpcad.spec.schema import Spec
from fpcad.units import DEG_PER_RAD

HOLD_S = 10.0
MOST_DRIFT_MM, MOST_DRIFT_DEG = 1.0, 2.0
PRELOADS = (0.7, 1.0, 1.3)
"""Factors on the grip preload: forces off by 30 % either way."""
DIRECTIONS = {
    "+x": (1.0, 0.0, 0.0),
    "-x": (-1.0, 0.0, 0.0),
    "+y": (0.0, 1.0, 0.0),
    "-y": (0.0, -1.0, 0.0),
    "+z": (0.0, 0.0, 1.0),
    "-z": (0.0, 0.0, -1.0),
}
"""Gravity along each axis of H."""


@dataclass(frozen=True)
class Hold:
    """How still the tool was."""

    gravity: str
    tool_mass_kg: float
    preload: float
    held: bool
    sag_mm: float
    """From the planned place to where it rests once the hand alone holds it."""
    sag_deg: float
    drift_mm: float
    """What it moves in HOLD_S after that."""
    drift_deg: float

    @property
    def still(self) -> bool:
        """Whether the drift is within what a hold may drift."""
        small = self.drift_mm <= MOST_DRIFT_MM and self.drift_deg <= MOST_DRIFT_DEG
        return self.held and small


def holds(hand: Any, spec: Spec, pose: str, trajectory: Trajectory) -> Iterator[Hold]:
    """All holds of a pose: both masses, three preloads, six directions of gravity."""
    resting = at_rest(trajectory)
    tried = itertools.product((LIGHT_KG, HEAVY_KG), PRELOADS, DIRECTIONS.items())
    for mass, preload, (name, gravity) in tried:
        trial = Trial(tool_mass_kg=mass, preload=preload, gravity=gravity)
        record = run_trial(hand, spec, pose, resting, trial)
        yield measured(record, resting, name, mass, preload)


def at_rest(trajectory: Trajectory) -> Trajectory:
    """The trajectory's first posture, held."""
    if trajectory.position_preload_rad is None:
        raise ValueError("the trajectory has no grip preload: export the hand again")
    still = np.zeros((2, trajectory.position_rad.shape[1]))
    tool = trajectory.tool
    return replace(
        trajectory,
        time_s=np.array([0.0, HOLD_S]),
        position_rad=np.repeat(trajectory.position_rad[:1], 2, axis=0),
        velocity_rad_s=still,
        acceleration_rad_s2=still,
        position_preload_rad=np.repeat(trajectory.position_preload_rad[:1], 2, axis=0),
        tool=ToolMotion(
            tool.radius_m, tool.back_m, tool.tip_m, np.zeros(2), np.repeat(tool.pose_palm[:1], 2, 0)
        ),
    )


def measured(
    record: Record, resting: Trajectory, gravity: str, mass: float, preload: float
) -> Hold:
    """Sag and drift of a record."""
    began = min(int(np.searchsorted(record.time_s, 0.0)), len(record.time_s) - 1)
    planned, start, end = resting.tool.pose_palm[0], record.tool_pose[began], record.tool_pose[-1]
    return Hold(
        gravity=gravity,
        tool_mass_kg=mass,
        preload=preload,
        held=bool(record.time_s[-1] >= resting.duration_s),
        sag_mm=1000.0 * float(np.linalg.norm(start[:3] - planned[:3])),
        sag_deg=_between(planned, start),
        drift_mm=1000.0 * float(np.linalg.norm(end[:3] - start[:3])),
        drift_deg=_between(start, end),
    )


def _between(a: np.ndarray, b: np.ndarray) -> float:
    """Angle [deg] between two poses (7,)."""
    first, second = (Rotation.from_quat(pose[3:], scalar_first=True) for pose in (a, b))
    return float((first.inv() * second).magnitude()) * DEG_PER_RAD
