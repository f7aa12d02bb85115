"""Trajectory files of a build: read, checked and brought into the controller's joint order."""

from __future__ import annotations

import json
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fpcad.run.acceptance import first_violation
from fpcad.run.errors import LimitsError, TrajectoryError
from fpcad.run.limits import JointLimits
from fpcad.run.messages import Reason
from fpcad.run.quintic import Knots

Array = NDArray[np.float64]

_RATES = ("position_rad", "velocity_rad_s", "acceleration_rad_s2")
_GOALS = "position_preload_rad"
_UNITS = {
    Reason.POSITION_LIMIT: ("position", "rad"),
    Reason.VELOCITY_LIMIT: ("velocity", "rad/s"),
    Reason.ACCELERATION_LIMIT: ("acceleration", "rad/s^2"),
}
_REST = 1e-6
"""Velocity [rad/s] and acceleration [rad/s^2] below which a joint rests: one count of the wire."""


@dataclass(frozen=True)
class Trajectory:
    """A motion of named joints, at rest at both ends."""

    joint_names: tuple[str, ...]
    knots: Knots

    @property
    def duration_s(self) -> float:
        """Time from the first knot to the last [s]."""
        return float(self.knots.time_s[-1] - self.knots.time_s[0])


def read_trajectory(path: Path) -> Trajectory:
    """Read a trajectory file and check all that can be checked without knowing the hand."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, json.JSONDecodeError) as error:
        raise TrajectoryError(f"{path}: cannot read the trajectory: {error}") from error
    try:
        return _checked(data)
    except ValueError as error:
        raise TrajectoryError(f"{path}: {error}") from error


def in_order(trajectory: Trajectory, limits: JointLimits) -> Knots:
    """Knots with columns in the controller's joint order."""
    missing = [name for name in limits.names if name not in trajectory.joint_names]
    extra = [name for name in trajectory.joint_names if name not in limits.names]
    if missing or extra:
        hint = get_close_matches(missing[0], extra, 1) if missing else []
        raise TrajectoryError(
            f"trajectory and hand have different joints: missing {missing}, unknown {extra}"
            + (f"; did you mean {hint[0]}?" if hint else "")
        )
    order = [trajectory.joint_names.index(name) for name in limits.names]
    k = trajectory.knots
    preload = None if k.preload is None else k.preload[:, order]
    columns = (column[:, order] for column in (k.position, k.velocity, k.acceleration))
    return Knots(k.time_s - k.time_s[0], *columns, preload=preload)


def slowed(knots: Knots, speed: float) -> Knots:
    """The same path at `speed` times the speed, 0 < speed <= 1."""
    if not 0 < speed <= 1:
        raise TrajectoryError(f"speed {speed:g}: must be greater than 0 and at most 1")
    return Knots(
        knots.time_s / speed,
        knots.position,
        knots.velocity * speed,
        knots.acceleration * speed**2,
        knots.preload,
    )


def repeated(knots: Knots, loops: int) -> Knots:
    """The same motion `loops` times in a row."""
    if loops < 1:
        raise TrajectoryError(f"loops {loops}: must be at least 1")
    if loops == 1:
        return knots
    ends = [knots.position] if knots.preload is None else [knots.position, knots.preload]
    if max(np.abs(column[-1] - column[0]).max() for column in ends) > 1e-4:
        raise TrajectoryError("the trajectory does not end where it starts, so it cannot loop")
    times = [knots.time_s[1:] + loop * knots.time_s[-1] for loop in range(loops)]

    def again(column: Array) -> Array:
        return np.concatenate([column[:1], *[column[1:]] * loops])

    return Knots(
        np.concatenate([knots.time_s[:1], *times]),
        *(again(column) for column in (knots.position, knots.velocity, knots.acceleration)),
        preload=None if knots.preload is None else again(knots.preload),
    )


def require_within(knots: Knots, limits: JointLimits) -> None:
    """Raise :class:`LimitsError` when any instant of the motion leaves the limits."""
    violation = first_violation(knots, limits)
    if violation is not None:
        quantity, unit = _UNITS[violation.reason]
        raise LimitsError(
            f"{limits.names[violation.joint]}: {quantity} reaches {violation.value:.6g} {unit} "
            f"after {violation.time_s:.3f} s; allowed is {violation.limit:.6g} {unit}"
        )


def _checked(data: Any) -> Trajectory:
    if not isinstance(data, dict):
        raise ValueError("must be a JSON object")
    absent = [key for key in ("joint_names", "time_s", *_RATES) if key not in data]
    if absent:
        raise ValueError(f"missing {', '.join(absent)}")
    names = data["joint_names"]
    if not isinstance(names, list) or not names or not all(isinstance(n, str) for n in names):
        raise ValueError("joint_names: must be a list of names")
    if len(set(names)) != len(names):
        raise ValueError("joint_names: a name stands twice")
    time_s = _numbers(data, "time_s")
    if time_s.ndim != 1 or len(time_s) < 2:
        raise ValueError(f"time_s: must be at least two numbers, not shape {time_s.shape}")
    if not (np.diff(time_s) > 0).all():
        worst = int(np.argmax(np.diff(time_s) <= 0)) + 1
        raise ValueError(f"time_s[{worst}]: must be greater than its predecessor")
    columns = [_numbers(data, key) for key in _RATES]
    for key, column in zip(_RATES, columns, strict=True):
        if column.shape != (len(time_s), len(names)):
            raise ValueError(f"{key}: shape {column.shape}, must be {(len(time_s), len(names))}")
    for key, column in zip(_RATES[1:], columns[1:], strict=True):
        if np.abs(column[[0, -1]]).max() > _REST:
            raise ValueError(f"{key}: must be zero in the first and in the last row")
        column[[0, -1]] = 0.0
    return Trajectory(tuple(names), Knots(time_s, *columns, preload=_preload(data, columns[0])))


def _preload(data: dict[str, Any], position_rad: Array) -> Array | None:
    """How far (N, n) the motors' goals lie beyond the positions, where the file has a grip."""
    if data.get(_GOALS) is None:
        return None
    goals = _numbers(data, _GOALS)
    if goals.shape != position_rad.shape:
        raise ValueError(f"{_GOALS}: shape {goals.shape}, must be {position_rad.shape}")
    return goals - position_rad


def _numbers(data: dict[str, Any], key: str) -> Array:
    try:
        values = np.array(data[key], dtype=float)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{key}: must hold numbers in rows of equal length") from error
    if not np.isfinite(values).all():
        raise ValueError(f"{key}: must be finite")
    return values
