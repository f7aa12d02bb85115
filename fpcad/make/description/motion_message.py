"""Trajectories in the shape of ROS 2's trajectory_msgs/JointTrajectory, as YAML."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

from fpcad.make.trajectory import Trajectory

NANO = 1_000_000_000


def joint_trajectory_yaml(trajectory: Trajectory) -> str:
    """The message, one point a line; its lines are JSON, which is YAML too.

    Positions are the kinematic ones. A controller that interpolates by quintic splines moves as the
    trajectory does, since velocities and accelerations are given at all points.
    """
    header: dict[str, Any] = {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""}
    lines = [
        f"header: {json.dumps(header)}",
        f"joint_names: {json.dumps(list(trajectory.joint_names))}",
        "points:",
        *(f"- {json.dumps(point, allow_nan=False)}" for point in _points(trajectory)),
    ]
    return "\n".join(lines) + "\n"


def _points(trajectory: Trajectory) -> Iterable[dict[str, Any]]:
    rows = zip(
        trajectory.time_s,
        trajectory.position_rad,
        trajectory.velocity_rad_s,
        trajectory.acceleration_rad_s2,
        strict=True,
    )
    for time, position, velocity, acceleration in rows:
        seconds, nanoseconds = divmod(round(time * NANO), NANO)
        yield {
            "positions": position.tolist(),
            "velocities": velocity.tolist(),
            "accelerations": acceleration.tolist(),
            "effort": [],
            "time_from_start": {"sec": seconds, "nanosec": nanoseconds},
        }
