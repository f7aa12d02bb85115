"""A twelve-joint hand and a trajectory file for it, made of closed forms."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from fpcad.run.limits import JointLimits
from fpcad.run.quintic import Knots

NAMES = tuple(
    f"{finger}_{joint}"
    for finger in ("thumb", "index", "middle", "ring")
    for joint in ("mcp_flex", "mcp_abd", "ip_flex")
)


def hand_limits(**changes) -> JointLimits:
    values = {
        "names": NAMES,
        "lower_rad": np.tile(np.radians([-10.0, -25.0, 0.0]), 4),
        "upper_rad": np.tile(np.radians([100.0, 25.0, 110.0]), 4),
        "velocity_rad_s": np.full(12, np.radians(90.0)),
        "acceleration_rad_s2": np.full(12, np.radians(720.0)),
    }
    return JointLimits(**{**values, **changes})


def swing(duration_s: float = 2.0, rows: int = 61, amplitude: float = 0.15) -> Knots:
    """q = q0 + amplitude sin^4(pi t / T) sin(k pi t / T): at rest, with zero acceleration, at both ends."""
    t = np.linspace(0.0, duration_s, rows)
    phase = np.pi * t / duration_s
    frequency = 1 + np.arange(12) % 3
    start = np.tile([0.5, 0.0, 0.6], 4)
    # A product of sines as a sum of exponentials, so that derivatives are exact.
    columns = [np.zeros((rows, 12)) for _ in range(3)]
    for j, k in enumerate(frequency):
        for m, weight in ((0, 6), (2, -4), (-2, -4), (4, 1), (-4, 1)):
            w = (m + k) * np.pi / duration_s
            columns[0][:, j] += weight / 16 * np.sin(w * t)
            columns[1][:, j] += weight / 16 * w * np.cos(w * t)
            columns[2][:, j] -= weight / 16 * w**2 * np.sin(w * t)
    del phase
    position, velocity, acceleration = (amplitude * column for column in columns)
    velocity[[0, -1]] = 0.0
    acceleration[[0, -1]] = 0.0
    position += start
    position[-1] = position[0]
    return Knots(t, position, velocity, acceleration)


def trajectory_data(knots: Knots | None = None) -> dict:
    knots = knots or swing()
    return {
        "joint_names": list(NAMES),
        "time_s": knots.time_s.tolist(),
        "position_rad": knots.position.tolist(),
        "velocity_rad_s": knots.velocity.tolist(),
        "acceleration_rad_s2": knots.acceleration.tolist(),
        "contacts": [{"finger": "thumb", "link": "distal"}],
    }


def write_trajectory(folder: Path, knots: Knots | None = None, **changes) -> Path:
    path = folder / "swing.json"
    path.write_text(json.dumps({**trajectory_data(knots), **changes}))
    return path
