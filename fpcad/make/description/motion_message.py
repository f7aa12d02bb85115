"""Trajectories in the shape of ROS 2's trajectory_msgs/JointTrajectory, as YAML."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fpcad.make.trajectory import Trajectory

NANO = 1_000_000_000


def messages(pose: str, trajectory: Trajectory) -> dict[str, str]:
    """Files of a pose's trajectory by name: the motion, and what to command to grip where known."""
    files = {f"{pose}.yaml": _yaml(trajectory, _motion(trajectory))}
    if trajectory.position_preload_rad is not None:
        files[f"{pose}.preload.yaml"] = _yaml(trajectory, _preload(trajectory.position_preload_rad))
    return files


def _yaml(trajectory: Trajectory, points: Iterable[dict[str, Any]]) -> str:
    """The message, one point a line; its lines are JSON, which is YAML too."""
    header: dict[str, Any] = {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""}
    lines = [
        f"header: {json.dumps(header)}",
        f"joint_names: {json.dumps(list(trajectory.joint_names))}",
        "points:",
    ]
    for point, time in zip(points, trajectory.time_s, strict=True):
        seconds, nanoseconds = divmod(round(time * NANO), NANO)
        since = {"sec": seconds, "nanosec": nanoseconds}
        whole = {**point, "effort": [], "time_from_start": since}
        lines.append(f"- {json.dumps(whole, allow_nan=False)}")
    return "\n".join(lines) + "\n"


def _motion(trajectory: Trajectory) -> Iterator[dict[str, Any]]:
    """A controller that interpolates these points by quintic splines moves as the trajectory does."""
    rows = trajectory.position_rad, trajectory.velocity_rad_s, trajectory.acceleration_rad_s2
    for position, velocity, acceleration in zip(*rows, strict=True):
        yield {
            "positions": position.tolist(),
            "velocities": velocity.tolist(),
            "accelerations": acceleration.tolist(),
        }


def _preload(commands: NDArray[np.float64]) -> Iterator[dict[str, Any]]:
    """Positions (N, n_joints) [rad] alone, between which a controller interpolates linearly."""
    for position in commands:
        yield {"positions": position.tolist(), "velocities": [], "accelerations": []}
