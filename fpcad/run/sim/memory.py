"""What a controller remembers, and how it comes to rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.run.framing import PROTOCOL_VERSION, FrameReader
from fpcad.run.knots import BUFFER_KNOTS
from fpcad.run.limits import JointLimits, to_counts
from fpcad.run.messages import (
    Cause,
    HomingOutcome,
    State,
)
from fpcad.run.motor_limits import motor_limits_of
from fpcad.run.sim.follower import PathFollower
from fpcad.run.sim.homing import HomingTour
from fpcad.run.sim.plant import Plant
from fpcad.run.sim.sequence import Sequence
from fpcad.run.transmission import transmission_of

_TELEMETRY_TICKS = 5
_HEALTH_TICKS = 25


@dataclass(frozen=True)
class ControllerSetup:
    """What is fixed in a controller's memory."""

    limits: JointLimits
    boot_nonce: int
    buffer_knots: int = BUFFER_KNOTS
    silence_us: int = 500_000
    """Silence of the host after which motion stops."""
    homed: bool = True
    protocol: int = PROTOCOL_VERSION
    build: bytes = b"fpcad-sim"


class ControllerMemory:
    """All that changes in a controller, as the firmware keeps it in one structure."""

    def __init__(self, setup: ControllerSetup, plant: Plant) -> None:
        self.setup = setup
        self.plant = plant
        self.gears = transmission_of(setup.limits)
        self.follower = PathFollower(
            setup.limits,
            setup.buffer_knots,
            plant.position,
            (self.gears, motor_limits_of(setup.limits)),
        )
        self.homed = setup.homed
        self.offset_urad = to_counts(self.gears.offset_rad)
        self.homing = HomingOutcome.NEVER
        self.tour: HomingTour | None = None
        self.state = State.READY if setup.homed else State.IDLE
        self.cause = Cause.NONE
        self.time_us = 0
        self.start_us = 0
        self.heard_us = 0
        self.session = 0
        self.sequence = Sequence()
        self.reader = FrameReader()
        self.gaps = 0
        self.output = bytearray()

    @property
    def measured(self) -> NDArray[np.float64]:
        """Where the joints are as far as the controller knows (n,) [rad]."""
        return self.plant.position

    @property
    def moving(self) -> bool:
        """Whether the joints are being led along a path."""
        return self.state is State.RUNNING or self.follower.rate > 0

    def settle(self) -> None:
        """The zeros are known; the goal is where the joints are."""
        self.homed, self.cause = True, Cause.NONE
        self.follower.rest_at(self.plant.position)
        self.plant.torque_on = True

    def stop_homing(self) -> None:
        """Break a search off, limp."""
        self.homing = HomingOutcome.STOPPED
        self.plant.torque_on = False
        self.follower.rest_at(self.plant.position)

    def stop(self, state: State, cause: Cause) -> None:
        """Slow down along the path, latched in `state`."""
        self.state, self.cause = state, cause
        self.follower.stop()

    def clear(self) -> None:
        """Unlatch: the goal becomes where the joints are, then torque comes back."""
        self.cause = Cause.NONE
        self.follower.rest_at(self.plant.position)
        self.plant.torque_on = self.homed

    def halt(self) -> None:
        """Emergency stop: torque off at once."""
        if self.state is State.HOMING:
            self.homing = HomingOutcome.STOPPED
        self.state, self.cause = State.ESTOP, Cause.HOST
        self.plant.torque_on = False
        self.follower.rest_at(self.plant.position)
