"""What a run asks of anything that drives joints: the seam for firmware and servo buses."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from fpcad.run.quintic import Knots

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Sample:
    """The joints at one instant, as the controller reports it."""

    device_s: float
    """Time of the controller's clock [s]."""
    path_s: float
    """Place on the path as path time [s]."""
    state: str
    cause: str
    position_rad: Array  # (n,) measured
    command_rad: Array  # (n,)
    queued_knots: int
    bad_frames: int
    """Frames that the controller could not read so far."""
    resends: int
    knots_sent: int
    current_ma: Array | None = None  # (n,) of the motors, where they tell
    temperature_c: Array | None = None  # (n,) of the motors
    preload_rad: Array | None = None  # (n,) by which the goals lie beyond the command
    gaps: int = 0
    """Gaps in what the controller heard so far."""

    @property
    def error_rad(self) -> Array:
        """(n,) how far the joints are from where they may be [rad].

        A joint with a preload may be anywhere from its command, held by the tool, to its goal, with
        nothing in its way.
        """
        goal = self.command_rad + (0.0 if self.preload_rad is None else self.preload_rad)
        low, high = np.minimum(self.command_rad, goal), np.maximum(self.command_rad, goal)
        return self.position_rad - np.clip(self.position_rad, low, high)


@dataclass(frozen=True)
class Played:
    """What a driver tells about a motion that it has finished."""

    knots: int
    resends: int
    bad_frames: int
    """Frames that one of the two sides could not read."""
    wire_error_rad: float
    """Largest distance between the motion asked for and the one that was sent."""
    final_state: str


@dataclass(frozen=True)
class Watch:
    """The run's ears: `on_sample` hears each sample, `stops` counts the user's requests to stop."""

    on_sample: Callable[[Sample], None]
    stops: Callable[[], int]


class Driver(Protocol):
    """Joints that can follow a path. Errors are :class:`fpcad.run.errors.RunError`."""

    identity: str
    """What answered, in words."""

    def ready(self, *, clear: bool) -> Sample:
        """Where the joints are, once they may move; `clear` unlatches HOLD, FAULT or ESTOP."""
        ...

    def wait(self, until: Callable[[], bool], watch: Watch) -> None:
        """Keep in touch while the joints stay where they are, until `until` is true."""
        ...

    def play(self, knots: Knots, watch: Watch) -> Played:
        """Follow the knots to the end, in real time.

        One request to stop: slow down along the path and hold. Two: torque off.
        """
        ...
