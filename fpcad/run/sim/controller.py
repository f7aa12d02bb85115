"""The controller: states and what changes them by themselves. Bytes and ticks go in, bytes come out."""

from __future__ import annotations

from fpcad.run.messages import (
    Cause,
    HomingOutcome,
    State,
)
from fpcad.run.sim import link, telemetry
from fpcad.run.sim.homing import HomingTour
from fpcad.run.sim.memory import ControllerMemory, ControllerSetup
from fpcad.run.sim.telemetry import TICK_HZ

_TELEMETRY_TICKS = 5
_HEALTH_TICKS = 25
_TRACKING_LIMIT_RAD = 0.15
_PLANT_SUBSTEPS = 4


__all__ = ["TICK_HZ", "Controller", "ControllerSetup"]


class Controller(ControllerMemory):
    """The simulated counterpart of the firmware; knows neither a port nor the wall clock."""

    def receive(self, data: bytes) -> None:
        """Take bytes from the host and answer every good frame."""
        for frame in self.reader.feed(data):
            link.take(self, frame)

    def take_output(self) -> bytes:
        """Bytes for the host since the last call."""
        data = bytes(self.output)
        self.output.clear()
        return data

    def tick(self) -> None:
        """Advance by one period of 4 ms."""
        self.time_us += 1_000_000 // TICK_HZ
        if self.state is State.RUNNING and self.follower.rate == 0:
            self._set_off_if_due()
        self.follower.step(1 / TICK_HZ)
        goal = self.follower.command + self.follower.preload
        if self.state is State.HOMING and self.tour is not None:
            goal = self.tour.command
            self._go_on_homing(self.tour)
        self.plant.step(goal, self.follower.command_velocity, 1 / TICK_HZ, _PLANT_SUBSTEPS)
        self._supervise()
        if self.session and self.time_us * TICK_HZ // 1_000_000 % _TELEMETRY_TICKS == 0:
            link.send(self, telemetry.place(self))
        if self.session and self.time_us * TICK_HZ // 1_000_000 % _HEALTH_TICKS == 0:
            link.send(self, telemetry.health(self))

    def _go_on_homing(self, tour: HomingTour) -> None:
        tour.step(1 / TICK_HZ)
        if tour.done:
            self.homing = HomingOutcome.FOUND
            self.settle()
            self.state = State.READY

    def _set_off_if_due(self) -> None:
        if self.time_us >= self.start_us:
            self.follower.start()

    def _supervise(self) -> None:
        silent = self.time_us - self.heard_us > self.setup.silence_us
        if self.state is State.ARMED and silent:
            self.state = State.READY
        if self.state is State.HOMING and silent:
            self.stop_homing()
            self.state, self.cause = State.IDLE, Cause.SILENCE
        if self.state is not State.RUNNING:
            return
        if self.follower.error(self.plant.position).max() > _TRACKING_LIMIT_RAD:
            self.stop(State.FAULT, Cause.TRACKING)
        elif self.follower.arrived:
            self.state = State.READY
        elif silent:
            self.stop(State.HOLD, Cause.SILENCE)
        elif self.follower.starving:
            self.stop(State.HOLD, Cause.UNDERRUN)
