"""What joints may do: read from a build, hashed for the handshake, in the wire's fixed point."""

from __future__ import annotations

import hashlib
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from fpcad.run.errors import TrajectoryError
from fpcad.run.messages import MAX_JOINTS, Limits

Array = NDArray[np.float64]

COUNTS_PER_UNIT = 1e6
"""Counts of the wire's fixed point: 1 urad, 1 urad/s, 1 urad/s^2."""
_LARGEST_COUNT = 2**31 - 1
PRELOAD_LIMIT_RAD = 0.5
"""Largest angle that a grip's goals may lie beyond the joints."""
PRELOAD_SPEED_RAD_S = 1.0
"""How fast they may move against the joints."""


@dataclass(frozen=True)
class JointLimits:
    """Limits of n joints in the controller's order."""

    names: tuple[str, ...]
    lower_rad: Array  # (n,)
    upper_rad: Array  # (n,)
    velocity_rad_s: Array  # (n,) > 0
    acceleration_rad_s2: Array  # (n,) > 0
    configuration: bytes = b""
    """What else the controller is set up with (transmission, calibration); part of the hash."""

    def __post_init__(self) -> None:
        columns = (self.lower_rad, self.upper_rad, self.velocity_rad_s, self.acceleration_rad_s2)
        if any(len(column) != len(self.names) for column in columns):
            raise ValueError(f"limits need one value for each of {len(self.names)} joints")
        if not 1 <= len(self.names) <= MAX_JOINTS or len(set(self.names)) != len(self.names):
            raise ValueError(f"limits need 1 to {MAX_JOINTS} different joints, not {self.names}")
        if not all(np.isfinite(column).all() for column in columns):
            raise ValueError("limits must be finite")
        if (self.lower_rad >= self.upper_rad).any():
            raise ValueError("each lower limit must lie below the upper one")
        if min(self.velocity_rad_s.min(), self.acceleration_rad_s2.min()) <= 0:
            raise ValueError("velocity and acceleration limits must be positive")

    def on_wire(self) -> Limits:
        """The limits as the controller reports them."""
        return Limits(
            to_counts(self.lower_rad),
            to_counts(self.upper_rad),
            to_counts(self.velocity_rad_s),
            to_counts(self.acceleration_rad_s2),
        )

    def hash(self) -> int:
        """64 bits that tell set-ups apart: names, limits and configuration."""
        wire = self.on_wire()
        digest = hashlib.sha256("\n".join(self.names).encode() + b"\0" + self.configuration)
        for column in (
            wire.lower_urad,
            wire.upper_urad,
            wire.velocity_urad_s,
            wire.acceleration_urad_s2,
        ):
            digest.update(struct.pack(f"<{len(column)}i", *column))
        return int.from_bytes(digest.digest()[:8], "little")


def to_counts(values: Array | Sequence[float]) -> tuple[int, ...]:
    """Values (n,) [rad, rad/s or rad/s^2] in counts of 1e-6; refuses what 32 bits cannot hold."""
    counts = np.rint(np.asarray(values, dtype=float) * COUNTS_PER_UNIT)
    if not (np.abs(counts) <= _LARGEST_COUNT).all():
        raise ValueError(f"{values} does not fit in 32 bits of 1e-6 rad")
    return tuple(int(count) for count in counts)


def from_counts(counts: Sequence[int]) -> Array:
    """Inverse of :func:`to_counts`."""
    return np.asarray(counts, dtype=float) / COUNTS_PER_UNIT


def read_limits(
    urdf: Path, acceleration_rad_s2: float, transmission: Path | None = None
) -> JointLimits:
    """Limits of all moving joints of a URDF, in its order.

    Args:
        urdf: file with `<limit lower= upper= velocity=>` at each revolute joint [rad, rad/s].
        acceleration_rad_s2: limit of every joint, since URDF has no place for it.
        transmission: file whose bytes become part of the configuration's hash.
    """
    joints = [joint for joint in parse_urdf(urdf).iter("joint") if joint.get("type") == "revolute"]
    rows = np.array([_limit_row(joint, urdf) for joint in joints]).reshape(-1, 3)
    try:
        return JointLimits(
            tuple(joint.get("name", "") for joint in joints),
            rows[:, 0],
            rows[:, 1],
            rows[:, 2],
            np.full(len(joints), acceleration_rad_s2),
            b"" if transmission is None else transmission.read_bytes(),
        )
    except (ValueError, OSError) as error:
        raise TrajectoryError(f"{urdf}: {error}") from error


def parse_urdf(urdf: Path) -> ElementTree.Element:
    """The root element of a URDF; :class:`TrajectoryError` where it cannot be read."""
    try:
        text = urdf.read_text(encoding="utf-8")
        # A URDF needs no document type, and refusing it keeps entity expansion out.
        if "<!DOCTYPE" in text:
            raise TrajectoryError(f"{urdf}: a document type is not allowed in a URDF")
        return ElementTree.fromstring(text)
    except (OSError, UnicodeDecodeError, ElementTree.ParseError) as error:
        raise TrajectoryError(f"{urdf}: cannot read the hand's joint limits: {error}") from error


def _limit_row(joint: ElementTree.Element, urdf: Path) -> tuple[float, float, float]:
    limit = joint.find("limit")
    try:
        if limit is None:
            raise ValueError("no <limit>")
        return (
            float(limit.attrib["lower"]),
            float(limit.attrib["upper"]),
            float(limit.attrib["velocity"]),
        )
    except (KeyError, ValueError) as error:
        raise TrajectoryError(
            f"{urdf}: joint {joint.get('name')}: needs <limit> with numbers lower, upper and "
            f"velocity: {error}"
        ) from error
