"""The controller: sessions, commands and states. Bytes and ticks go in, bytes come out."""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fpcad.run.codec import CLASSES, KINDS, MalformedMessage, decode, encode
from fpcad.run.framing import PROTOCOL_VERSION, Frame, FrameReader, encode_frame
from fpcad.run.knots import BUFFER_KNOTS
from fpcad.run.limits import COUNTS_PER_UNIT, JointLimits, from_counts, to_counts
from fpcad.run.messages import (
    PRELOAD_URAD,
    Ack,
    Arm,
    AskHoming,
    AskLimits,
    Calibrate,
    Cause,
    Clear,
    End,
    Estop,
    Health,
    Hello,
    Hold,
    Home,
    HomingOutcome,
    HomingReport,
    Knot,
    Nak,
    NoSession,
    Ping,
    Pong,
    Reason,
    Refused,
    Start,
    State,
    Telemetry,
    Welcome,
)
from fpcad.run.motor_limits import motor_limits_of
from fpcad.run.sim.follower import PathFollower
from fpcad.run.sim.homing import HomingTour
from fpcad.run.sim.plant import Plant
from fpcad.run.sim.sequence import DONE, Sequence
from fpcad.run.sim.states import NEXT
from fpcad.run.transmission import transmission_of

TICK_HZ = 250
_TELEMETRY_TICKS = 5
_HEALTH_TICKS = 25
_MA_PER_NM = 930
"""What a servo of 2.9 N m at 2.7 A draws."""
_AMBIENT_C = 25
_PREFILL_US = 500_000
_START_WINDOW_US = (0, 60_000_000)
"""How far ahead of the controller's clock a Start may lie."""
_TRACKING_LIMIT_RAD = 0.15
_PLANT_SUBSTEPS = 4


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


class Controller:
    """The simulated counterpart of the firmware; knows neither a port nor the wall clock."""

    def __init__(self, setup: ControllerSetup, plant: Plant) -> None:
        self._setup = setup
        self.plant = plant
        self._gears = transmission_of(setup.limits)
        self.follower = PathFollower(
            setup.limits,
            setup.buffer_knots,
            plant.position,
            (self._gears, motor_limits_of(setup.limits)),
        )
        self.homed = setup.homed
        self._offset_urad = to_counts(self._gears.offset_rad)
        self._homing = HomingOutcome.NEVER
        self._tour: HomingTour | None = None
        self.state = State.READY if setup.homed else State.IDLE
        self.cause = Cause.NONE
        self.time_us = 0
        self._start_us = 0
        self._heard_us = 0
        self._session = 0
        self._sequence = Sequence()
        self._reader = FrameReader()
        self._gaps = 0
        self._output = bytearray()

    @property
    def measured(self) -> NDArray[np.float64]:
        """Where the joints are as far as the controller knows (n,) [rad]."""
        return self.plant.position

    @property
    def moving(self) -> bool:
        """Whether the joints are being led along a path."""
        return self.state is State.RUNNING or self.follower.rate > 0

    def receive(self, data: bytes) -> None:
        """Take bytes from the host and answer every good frame."""
        for frame in self._reader.feed(data):
            self._on_frame(frame)

    def take_output(self) -> bytes:
        """Bytes for the host since the last call."""
        data = bytes(self._output)
        self._output.clear()
        return data

    def tick(self) -> None:
        """Advance by one period of 4 ms."""
        self.time_us += 1_000_000 // TICK_HZ
        if self.state is State.RUNNING and self.follower.rate == 0:
            self._set_off_if_due()
        self.follower.step(1 / TICK_HZ)
        goal = self.follower.command + self.follower.preload
        if self.state is State.HOMING and self._tour is not None:
            goal = self._tour.command
            self._go_on_homing(self._tour)
        self.plant.step(goal, self.follower.command_velocity, 1 / TICK_HZ, _PLANT_SUBSTEPS)
        self._supervise()
        if self._session and self.time_us * TICK_HZ // 1_000_000 % _TELEMETRY_TICKS == 0:
            self._send(self._telemetry())
        if self._session and self.time_us * TICK_HZ // 1_000_000 % _HEALTH_TICKS == 0:
            self._send(self._health())

    def _go_on_homing(self, tour: HomingTour) -> None:
        tour.step(1 / TICK_HZ)
        if tour.done:
            self._homing = HomingOutcome.FOUND
            self._settle()
            self.state = State.READY

    def _settle(self) -> None:
        """The zeros are known; the goal is where the joints are."""
        self.homed, self.cause = True, Cause.NONE
        self.follower.rest_at(self.plant.position)
        self.plant.torque_on = True

    def _stop_homing(self) -> None:
        self._homing = HomingOutcome.STOPPED
        self.plant.torque_on = False
        self.follower.rest_at(self.plant.position)

    def _set_off_if_due(self) -> None:
        if self.time_us >= self._start_us:
            self.follower.start()

    def _supervise(self) -> None:
        silent = self.time_us - self._heard_us > self._setup.silence_us
        if self.state is State.ARMED and silent:
            self.state = State.READY
        if self.state is State.HOMING and silent:
            self._stop_homing()
            self.state, self.cause = State.IDLE, Cause.SILENCE
        if self.state is not State.RUNNING:
            return
        if self.follower.error(self.plant.position).max() > _TRACKING_LIMIT_RAD:
            self._stop(State.FAULT, Cause.TRACKING)
        elif self.follower.arrived:
            self.state = State.READY
        elif silent:
            self._stop(State.HOLD, Cause.SILENCE)
        elif self.follower.starving:
            self._stop(State.HOLD, Cause.UNDERRUN)

    def _stop(self, state: State, cause: Cause) -> None:
        self.state, self.cause = state, cause
        self.follower.stop()

    def _clear(self) -> None:
        """Unlatch: the goal becomes where the joints are, then torque comes back."""
        self.cause = Cause.NONE
        self.follower.rest_at(self.plant.position)
        self.plant.torque_on = self.homed

    def _on_frame(self, frame: Frame) -> None:
        cls = CLASSES.get(frame.kind)
        if cls is Hello:
            self._on_hello(frame)
        elif frame.version != self._setup.protocol or cls is None or frame.kind >= 0x40:
            return
        elif cls is Estop:
            self._halt()
            self._send(self._ack(), frame.session)
        elif frame.session != self._session or not self._session:
            self._send(NoSession(self._setup.boot_nonce), frame.session)
        else:
            self._heard_us = self.time_us
            self._on_session_frame(frame, cls)

    def _on_hello(self, frame: Frame) -> None:
        if frame.session != self._session and not self.moving:
            self._session, self._sequence = frame.session, Sequence()
            self._heard_us = self.time_us
            if self.state is State.ARMED:
                self.state = State.READY
        setup = self._setup
        joints = len(setup.limits.names)
        welcome = Welcome(
            setup.protocol,
            joints,
            self.state,
            self.cause,
            TICK_HZ,
            setup.buffer_knots,
            setup.boot_nonce,
            setup.limits.hash(),
            int(self.homed),
            zlib.crc32(encode(Calibrate(self._offset_urad))) if self.homed else 0,
            setup.build,
        )
        self._send(welcome, frame.session)

    def _on_session_frame(self, frame: Frame, cls: type) -> None:
        if KINDS[cls].sequenced:
            reply = self._sequence.take(frame, self._perform)
            self._gaps += isinstance(reply, Nak)
            if reply is not None:
                self._send(self._ack() if reply is DONE else reply)
            return
        try:
            msg = decode(frame.kind, frame.payload)
        except MalformedMessage:
            self._reader.bad_frames += 1
            return
        if isinstance(msg, Ping):
            self._send(Pong(msg.host_us, self.time_us))
        elif isinstance(msg, AskLimits):
            self._send(self._setup.limits.on_wire())
        elif isinstance(msg, AskHoming):
            self._send(self._homing_report())
        elif isinstance(msg, Hold):
            if self.state is State.HOMING:
                self._stop_homing()
            if NEXT[self.state, Hold] is not self.state:
                self._stop(NEXT[self.state, Hold], Cause.HOST)
            self._send(self._ack())

    def _perform(self, frame: Frame) -> Refused | None:
        """Carry out one sequenced command, or leave everything as it is and say why."""
        reason, joint = self._attempt(frame) or (None, 0)
        if reason is None:
            return None
        return Refused(frame.seq, frame.kind, reason, joint, self.state, self.cause)

    def _attempt(self, frame: Frame) -> tuple[Reason, int] | None:
        try:
            msg = decode(frame.kind, frame.payload)
        except MalformedMessage:
            return Reason.MALFORMED, 0
        following = NEXT.get((self.state, type(msg)))
        if following is None:
            return Reason.WRONG_STATE, 0
        refusal = self._act(msg)
        if refusal is None:
            unhomed = following is State.READY and not self.homed
            self.state = State.IDLE if unhomed else following
        return refusal

    def _act(self, msg: Any) -> tuple[Reason, int] | None:
        if isinstance(msg, Knot):
            return self.follower.offer(msg, self.plant.position)
        if isinstance(msg, Start):
            return self._schedule(msg.device_us)
        if isinstance(msg, End):
            reason = self.follower.end(msg.knots)
            return None if reason is None else (reason, 0)
        if isinstance(msg, Arm):
            self.follower.forget()
        if isinstance(msg, Home):
            self.homed, self._homing = False, HomingOutcome.SEARCHING
            self.plant.torque_on = True
            self._tour = HomingTour(self._setup.limits, self.plant.position)
        if isinstance(msg, Calibrate):
            return self._calibrate(msg)
        if isinstance(msg, Clear):
            if self.follower.rate > 0:
                return Reason.STILL_MOVING, 0
            self._clear()
        return None

    def _calibrate(self, msg: Calibrate) -> tuple[Reason, int] | None:
        """Keep zeros that put each joint within its range, or a tenth of it beyond."""
        limits, gears = self._setup.limits, self._gears
        if len(msg.offset_urad) != len(limits.names):
            return Reason.MALFORMED, 0
        wrong = gears.offset_rad - from_counts(msg.offset_urad)
        joint = self.plant.position + np.linalg.solve(gears.matrix, wrong)
        margin = (limits.upper_rad - limits.lower_rad) / 10
        outside = (joint < limits.lower_rad - margin) | (joint > limits.upper_rad + margin)
        if outside.any():
            return Reason.IMPLAUSIBLE, int(np.flatnonzero(outside)[0])
        self._offset_urad = msg.offset_urad
        self._homing = HomingOutcome.CALIBRATED
        self._settle()
        return None

    def _schedule(self, device_us: int) -> tuple[Reason, int] | None:
        earliest, latest = _START_WINDOW_US
        if not earliest <= device_us - self.time_us <= latest:
            return Reason.START_TIME, 0
        if self.follower.queued_us < _PREFILL_US and not self.follower.ended:
            return Reason.TOO_LITTLE_PREFILL, 0
        self._start_us = device_us
        return None

    def _halt(self) -> None:
        """Emergency stop: torque off at once."""
        if self.state is State.HOMING:
            self._homing = HomingOutcome.STOPPED
        self.state, self.cause = State.ESTOP, Cause.HOST
        self.plant.torque_on = False
        self.follower.rest_at(self.plant.position)

    def _ack(self) -> Ack:
        return Ack(self._sequence.expected, self.follower.free, self.state)

    def _telemetry(self) -> Telemetry:
        follower = self.follower
        at_rest = self.plant.torque_on
        return Telemetry(
            self.time_us,
            follower.path_us,
            self.state,
            self.cause,
            round(1000 * follower.rate),
            follower.queued,
            self._reader.bad_frames & 0xFFFF,
            to_counts(self.plant.position),
            to_counts(follower.command if at_rest else self.plant.position),
        )

    def _health(self) -> Health:
        return Health(
            self.time_us,
            self._gaps & 0xFFFF,
            tuple(int(x) for x in self.plant.torque * _MA_PER_NM),
            (_AMBIENT_C,) * len(self.plant.position),
            tuple(round(x * COUNTS_PER_UNIT / PRELOAD_URAD) for x in self.follower.preload),
        )

    def _homing_report(self) -> HomingReport:
        limits = self._setup.limits.on_wire()
        joints = len(limits.lower_urad)
        found = joints if self._homing is HomingOutcome.FOUND else 0
        if self._tour is not None and self._homing is not HomingOutcome.CALIBRATED:
            found = joints if self._tour.done else self._tour.joint
        nothing = (0,) * (joints - found)
        return HomingReport(
            self._homing,
            0 if self._tour is None else self._tour.joint,
            self._offset_urad,
            limits.lower_urad[:found] + nothing,
            limits.upper_urad[:found] + nothing,
        )

    def _send(self, msg: Any, session: int | None = None) -> None:
        kind = KINDS[type(msg)]
        self._output += encode_frame(
            Frame(
                kind.code,
                0,
                self._session if session is None else session,
                encode(msg),
                self._setup.protocol,
            )
        )
