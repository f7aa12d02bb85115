"""The hand that clay starts from, gripping its tool at a pose; plain bodies, no path."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from fpcad.make.preload.tighten import tightened
from fpcad.make.trajectory import ToolMotion, Trajectory
from fpcad.simulate.candidate import plain_hand
from fpcad.simulate.roll import Record
from fpcad.simulate.setting import Trial
from fpcad.simulate.trials import run_trial
from tests.make.mechanism import Mechanism, mechanism

SECONDS = 0.4


@dataclass(frozen=True)
class Gripping:
    """A pose held for a while."""

    mechanism: Mechanism

    @cached_property
    def trajectory(self) -> Trajectory:
        m, still = self.mechanism, np.zeros((2, 12))
        origin, orientation = m.grip.tool_poses(np.zeros(1))
        pose = np.concatenate([origin[0] / 1000.0, orientation.as_quat(scalar_first=True)[0]])
        tool = m.spec.tool
        joints = [
            f"{f}_{j}" for f in m.geometry.fingers for j in ("mcp_flex", "mcp_abd", "ip_flex")
        ]
        touching = Trajectory(
            joint_names=tuple(joints),
            time_s=np.array([0.0, SECONDS]),
            position_rad=np.tile(m.posture, (2, 1)),
            velocity_rad_s=still,
            acceleration_rad_s2=still,
            contacts=m.grip.contacts,
            tool=ToolMotion(
                tool.radius_mm / 1000.0,
                tool.back_mm / 1000.0,
                tool.tip_mm / 1000.0,
                np.zeros(2),
                np.tile(pose, (2, 1)),
            ),
        )
        return tightened(touching, m.spec, m.pose, m.geometry, m.hand_in_tool)[0]

    @cached_property
    def hand(self) -> Any:
        m = self.mechanism
        return plain_hand(m.spec, m.geometry, {})

    def run(self, **trial) -> Record:
        spec = self.mechanism.spec
        return run_trial(self.hand, spec, self.mechanism.pose, self.trajectory, Trial(**trial))

    def without_preload(self) -> Trajectory:
        return replace(self.trajectory, position_preload_rad=None)


def gripping(pose: str) -> Gripping:
    """Clay's first hand in a pose."""
    return Gripping(mechanism(pose))
