"""What a trial shows: how far the tool was turned, whether it was held and led, what slid and saturated."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fpcad.make.trajectory import Trajectory
from fpcad.simulate.roll import Record
from fpcad.simulate.setting import CONTROL_PERIOD_S
from fpcad.spec.pose import Turning
from fpcad.units import DEG_PER_RAD

Array = NDArray[np.float64]

SATURATED = 0.999
"""Share of a motor's limit from which it counts as saturated."""
TIPPED_DEG = 30.0
"""Tilt of the tool's axis out of its planned motion from which it is no longer wielded, though it may be held."""
ALONG_AXIS = 0.9
"""Cosine between tool and turning axis from which turning is spinning the tool about itself."""


@dataclass(frozen=True)
class Outcome:
    """A trial in figures."""

    held: bool
    """Whether the tool was in the hand to the end."""
    lost_at_s: float | None
    """Time on the trajectory at which it was lost."""
    tipped_at_s: float | None
    """Time at which it was first tilted by `TIPPED_DEG`; None where it never was."""
    planned_deg: float
    """Range of the tool's angle that the trajectory plans."""
    reached_deg: float
    """Part of that range that the tool passed while it was held and before it tipped."""
    worst_tilt_deg: float
    """Largest tilt of the tool's axis out of its planned motion."""
    worst_offset_mm: float
    """Largest distance of the tool's frame from its planned place."""
    slip_mm: tuple[float, ...]
    """Way that finger and tool slid on each other, for each contact."""
    contact_share: tuple[float, ...]
    """Share of the time in which each contact was closed."""
    saturated_share: float
    """Share of the time in which at least one motor was at its limit."""
    largest_motor_nm: float

    def as_values(self) -> dict[str, Any]:
        """All figures, what follows from them too, as plain values."""
        return asdict(self) | {"wielded": self.wielded, "reached_share": self.reached_share}

    @property
    def wielded(self) -> bool:
        """Whether the tool was held to the end and never tipped."""
        return self.held and self.tipped_at_s is None

    @property
    def reached_share(self) -> float:
        """Part of the planned range that was reached [-]; 1 where nothing was planned."""
        return self.reached_deg / self.planned_deg if self.planned_deg else 1.0


def outcome(record: Record, trajectory: Trajectory, turning: Turning, limit_nm: float) -> Outcome:
    """The figures of a record; `limit_nm` is the torque at which a motor counts as saturated."""
    moving = record.time_s > 0.0
    held = bool(record.time_s[-1] >= trajectory.duration_s)
    turned, tilt = tool_angles(record, trajectory, turning)
    plan = trajectory.tool.angle_rad
    low, high = plan.min(), plan.max()
    tipped = np.flatnonzero(np.abs(tilt) * DEG_PER_RAD >= TIPPED_DEG)
    moving[tipped[0] if len(tipped) else len(moving) :] = False
    seen = turned[moving] if moving.any() else np.zeros(1)
    reached = max(0.0, min(seen.max(), high)) - min(0.0, max(seen.min(), low))
    offset = np.linalg.norm(record.tool_pose[:, :3] - record.planned_position_m, axis=1)
    motors = np.abs(record.motor_nm)
    return Outcome(
        held=held,
        lost_at_s=None if held else float(record.time_s[-1]),
        tipped_at_s=float(record.time_s[tipped[0]]) if len(tipped) else None,
        planned_deg=float(high - low) * DEG_PER_RAD,
        reached_deg=float(reached) * DEG_PER_RAD,
        worst_tilt_deg=float(np.abs(tilt).max()) * DEG_PER_RAD,
        worst_offset_mm=1000.0 * float(offset.max()),
        slip_mm=tuple((record.slip_mm_s.sum(axis=0) * CONTROL_PERIOD_S).tolist()),
        contact_share=tuple((record.normal_n > 0.0).mean(axis=0).tolist()),
        saturated_share=float((motors >= SATURATED * limit_nm).any(axis=1).mean()),
        largest_motor_nm=float(motors.max()),
    )


def tool_angles(record: Record, trajectory: Trajectory, turning: Turning) -> tuple[Array, Array]:
    """Turn (T,) about the pose's axis, and tilt (T,) of the tool's axis out of its cone [rad].

    A round tool's spin about itself shows nothing, so both are those of the tool's axis; only a
    tool that is turned about itself is followed by its whole orientation.
    """
    start = Rotation.from_quat(trajectory.tool.pose_palm[0, 3:], scalar_first=True)
    moved = start.inv() * Rotation.from_quat(record.tool_pose[:, 3:], scalar_first=True)
    axis = np.array(turning.axis) / np.linalg.norm(turning.axis)
    x = np.array([1.0, 0.0, 0.0])
    along = moved.apply(x)
    tilt = np.arccos(np.clip(along @ axis, -1, 1)) - np.arccos(np.clip(x @ axis, -1, 1))
    if abs(axis @ x) > ALONG_AXIS:
        quaternion = moved.as_quat(scalar_first=True)
        return np.unwrap(2 * np.arctan2(quaternion[:, 1:] @ axis, quaternion[:, 0])), tilt
    zero = x - (x @ axis) * axis
    turned = np.arctan2(along @ np.cross(axis, zero), along @ zero)
    return np.unwrap(turned), tilt
