"""What a run tells about itself: progress, and how well the joints followed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.run.driver import Sample

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Progress:
    """Where a run is."""

    path_s: float
    """Path time reached [s]."""
    total_s: float
    """Path time of the whole run [s]."""
    knots_sent: int
    resends: int
    state: str
    error_rad: float
    """Largest tracking error of the latest sample [rad]."""
    sample: Sample
    """The latest sample, for those who show joints."""


@dataclass(frozen=True)
class RunReport:
    """A run that reached its end. Tuples hold one number a joint, in the order of `joint_names`."""

    controller: str
    seconds: float
    """Path time of the run, the way to its start included [s]."""
    knots: int
    resends: int
    bad_frames: int
    samples: int
    """Telemetry samples that the errors are taken from."""
    joint_names: tuple[str, ...]
    max_error_rad: tuple[float, ...]
    """Largest error of each joint [rad], see :attr:`fpcad.run.driver.Sample.error_rad`."""
    rms_error_rad: tuple[float, ...]
    """Root mean square of the same [rad]."""
    max_error_all_rad: float
    """Largest over all joints [rad]."""
    rms_error_all_rad: float
    """Root mean square over all joints [rad]."""
    wire_error_rad: float
    """Largest distance between the motion in the file and the one that was sent [rad]."""
    final_state: str


class TrackingError:
    """Sums up how far n joints are from where they may be while they move, see :attr:`Sample.error_rad`."""

    def __init__(self, joints: int) -> None:
        self.samples = 0
        self._largest = np.zeros(joints)
        self._squares = np.zeros(joints)

    def add(self, sample: Sample) -> float:
        """Take a sample in; its largest error [rad]."""
        error = np.abs(sample.error_rad)
        if sample.state == "RUNNING":
            self.samples += 1
            self._largest = np.maximum(self._largest, error)
            self._squares += error**2
        return float(error.max())

    @property
    def max_rad(self) -> Array:
        """Largest error (n,) [rad]."""
        return self._largest

    @property
    def rms_rad(self) -> Array:
        """Root mean square error (n,) [rad]."""
        return np.sqrt(self._squares / max(self.samples, 1))
