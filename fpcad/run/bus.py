"""What every kind of motor can be asked: the one interface of all drivers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from fpcad.run.errors import GoalRefused

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Identity:
    """Who answered on one axis."""

    axis: str
    number: int
    """Its id on the bus, or its place in the controller's order."""
    model: str
    firmware: str


@dataclass(frozen=True)
class BusState:
    """All axes at one instant."""

    position_rad: Array  # (n,)
    current_ma: Array  # (n,)
    temperature_c: Array  # (n,)
    torque_on: bool
    bad_frames: int
    """Answers so far that could not be read."""


class MotorBus(Protocol):
    """Axes that go where they are told. Errors are :class:`fpcad.run.errors.RunError`.

    An axis is a motor on a servo bus, and a joint behind the project's own firmware, which keeps its
    motors to itself. After `open` nothing moves and nothing has changed until `torque(True)`.
    """

    names: tuple[str, ...]
    """The axes, in the order of all arrays."""
    without_host: str
    """What the motors do when the host falls silent, as the end of a sentence on the hand."""

    def open(self) -> None:
        """Take the port for this program alone, and make sure that all axes are there."""
        ...

    def identify(self) -> tuple[Identity, ...]:
        """Who answers on each axis."""
        ...

    def read_state(self) -> BusState:
        """Where the axes are now."""
        ...

    def write_goals(self, goal_rad: Array) -> None:
        """Axes go to these positions (n,). The latest goal counts.

        A servo goes at once, so goals should come often and lie close together; a controller makes
        a slow straight move of its own, and finishes it before it takes up the next.
        """
        ...

    def torque(self, on: bool) -> None:
        """Let motors pull or let go. Before they pull, their goal is where they are."""
        ...

    def watchdog(self, timeout_s: float) -> bool:
        """Ask that motors stop by themselves after a silence; whether they can.

        A watchdog that has tripped is cleared. Where they cannot, they keep their last goal.
        """
        ...

    def close(self) -> None:
        """Give the port back; motors stay as they are. Closing twice does no harm."""
        ...


class ServoBus(MotorBus, Protocol):
    """Motors whose force the host may limit: what homing and calibration need."""

    def limit_torque(self, share: float) -> None:
        """Motors pull with at most this share, 0 to 1, of what they can."""
        ...

    @property
    def goal_range_rad(self) -> tuple[float, float]:
        """Least and greatest goal that a motor takes."""
        ...

    @property
    def torque_per_ma(self) -> float:
        """Torque of a motor for each mA that it draws [N m / mA]."""
        ...


def checked_goals(
    names: tuple[str, ...],
    goal_rad: Array,
    lower_rad: Array | float = -np.inf,
    upper_rad: Array | float = np.inf,
) -> Array:
    """Goals (n,) as sent; :class:`GoalRefused` where they are not n finite numbers in their range."""
    goal = np.asarray(goal_rad, dtype=float)
    if goal.shape != (len(names),):
        raise GoalRefused(f"goals of shape {goal.shape} for {len(names)} axes; nothing was sent")
    lower = np.broadcast_to(np.asarray(lower_rad, dtype=float), goal.shape)
    upper = np.broadcast_to(np.asarray(upper_rad, dtype=float), goal.shape)
    for name, value, low, high in zip(names, goal, lower, upper, strict=True):
        if not low <= value <= high or not np.isfinite(value):
            raise GoalRefused(
                f"{name}: goal {value:.4g} rad, allowed is {low:.4g} to {high:.4g}; nothing was sent"
            )
    return goal
