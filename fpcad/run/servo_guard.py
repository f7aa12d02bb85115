"""What stops a run on a servo bus, and the word for it in the run's table."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fpcad.run.bus import BusState
from fpcad.run.errors import (
    HeldByUser,
    LinkLost,
    ServoFault,
    ServoSilent,
    StoppedByUser,
    WatchdogTripped,
)
from fpcad.run.messages import Cause
from fpcad.run.motor_map import MotorMap
from fpcad.run.sim.follower import PathFollower

_TRACKING_LIMIT_RAD = 0.15
_STRIKES = 2
"""Cycles in a row that make a fault of what may be noise."""
_CAUSES = {
    HeldByUser: Cause.HOST.name,
    StoppedByUser: Cause.HOST.name,
    WatchdogTripped: Cause.SILENCE.name,
    ServoSilent: Cause.MOTOR_LOST.name,
    ServoFault: "SERVO",
    LinkLost: "LINK",
}
"""Causes as a controller would tell them; a servo's own complaint, and the line, it could not."""


@dataclass(frozen=True)
class ServoGuards:
    """What stops a run, beside a servo's own complaints."""

    current_ma: float
    temperature_c: float = 70.0
    tracking_rad: float = _TRACKING_LIMIT_RAD


class GuardTripped(ServoFault):
    """One of :class:`ServoGuards`; `cause` is its word."""

    def __init__(self, message: str, cause: Cause) -> None:
        super().__init__(message)
        self.cause = cause


class ServoGuard:
    """Looks at each cycle of a run; `motors`: names of the bus's axes."""

    def __init__(self, guards: ServoGuards, motors: tuple[str, ...]) -> None:
        self._guards, self._motors = guards, motors
        self._strikes = 0

    def check(self, state: BusState, follower: PathFollower, known: MotorMap) -> None:
        """Raise :class:`GuardTripped` at the second cycle in a row that is out of bounds."""
        found = self._complaint(state, follower, known)
        self._strikes = self._strikes + 1 if found else 0
        if found and self._strikes >= _STRIKES:
            raise GuardTripped(*found)

    def _complaint(
        self, state: BusState, follower: PathFollower, known: MotorMap
    ) -> tuple[str, Cause] | None:
        error = follower.error(known.to_joints(state.position_rad))
        guards, motors = self._guards, self._motors
        for names, values, limit, what, cause in (
            (
                known.joints, error, guards.tracking_rad,
                "does not follow, {:.2f} rad behind", Cause.TRACKING,
            ),
            (motors, state.current_ma, guards.current_ma, "draws {:.0f} mA", Cause.CURRENT),
            (
                motors, state.temperature_c, guards.temperature_c,
                "is at {:.0f} degrees C", Cause.TEMPERATURE,
            ),
        ):  # fmt: skip
            worst = int(np.argmax(values))
            if values[worst] > limit:
                said = what.format(values[worst])
                place = f"at {follower.path_us / 1e6:.2f} s of the path"
                return f"{names[worst]} {said} {place}; find out what blocks it", cause
        return None


def cause_of(error: BaseException) -> str:
    """The word for what ended a run; NONE for what has nothing to do with motors."""
    if isinstance(error, GuardTripped):
        return error.cause.name
    found = (word for kind, word in _CAUSES.items() if isinstance(error, kind))
    return next(found, Cause.NONE.name)
