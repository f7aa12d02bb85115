"""Trajectory files: JSON in SI units, written in one step."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from fpcad.errors import StoreError
from fpcad.make.documents.stamp import Stamp
from fpcad.make.grip import ContactLink
from fpcad.make.trajectory import ToolMotion, Trajectory


def write_trajectory(trajectory: Trajectory, file: Path, stamp: Stamp) -> None:
    """Write a trajectory; equal trajectories give equal bytes, and `file` is never half written."""
    text = json.dumps(_document(trajectory), allow_nan=False, separators=(",", ":"))
    stamp.write(file, text + "\n")


def read_trajectory(file: Path) -> Trajectory:
    """Read what :func:`write_trajectory` wrote; raises StoreError where the file is damaged."""
    try:
        return _trajectory(json.loads(file.read_text(encoding="utf-8")))
    except KeyError as error:
        raise StoreError(f"{file}: the key {error} is missing") from error
    except (ValueError, TypeError) as error:
        raise StoreError(f"{file}: {error}") from error


def _document(trajectory: Trajectory) -> dict[str, Any]:
    document: dict[str, Any] = {
        "joint_names": list(trajectory.joint_names),
        "time_s": trajectory.time_s.tolist(),
        "position_rad": trajectory.position_rad.tolist(),
        "velocity_rad_s": trajectory.velocity_rad_s.tolist(),
        "acceleration_rad_s2": trajectory.acceleration_rad_s2.tolist(),
        "contacts": [{"finger": c.finger, "link": c.link} for c in trajectory.contacts],
        "tool": {
            "radius_m": trajectory.tool.radius_m,
            "back_m": trajectory.tool.back_m,
            "tip_m": trajectory.tool.tip_m,
            "angle_rad": trajectory.tool.angle_rad.tolist(),
            "pose_palm": trajectory.tool.pose_palm.tolist(),
        },
    }
    if trajectory.position_preload_rad is not None:
        document["position_preload_rad"] = trajectory.position_preload_rad.tolist()
    return document


def _trajectory(document: dict[str, Any]) -> Trajectory:
    tool, preload = document["tool"], document.get("position_preload_rad")
    return Trajectory(
        joint_names=tuple(document["joint_names"]),
        time_s=np.array(document["time_s"], dtype=float),
        position_rad=np.array(document["position_rad"], dtype=float),
        velocity_rad_s=np.array(document["velocity_rad_s"], dtype=float),
        acceleration_rad_s2=np.array(document["acceleration_rad_s2"], dtype=float),
        contacts=tuple(ContactLink(c["finger"], c["link"]) for c in document["contacts"]),
        tool=ToolMotion(
            radius_m=float(tool["radius_m"]),
            back_m=float(tool["back_m"]),
            tip_m=float(tool["tip_m"]),
            angle_rad=np.array(tool["angle_rad"], dtype=float),
            pose_palm=np.array(tool["pose_palm"], dtype=float),
        ),
        position_preload_rad=None if preload is None else np.array(preload, dtype=float),
    )
