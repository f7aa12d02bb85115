"""What sequenced commands do, or why they are refused with nothing changed."""

from __future__ import annotations

from typing import Any

import numpy as np

from fpcad.run.codec import MalformedMessage, decode
from fpcad.run.framing import Frame
from fpcad.run.limits import from_counts
from fpcad.run.messages import (
    Arm,
    Calibrate,
    Clear,
    End,
    Home,
    HomingOutcome,
    Knot,
    Reason,
    Refused,
    Start,
    State,
)
from fpcad.run.sim.homing import HomingTour
from fpcad.run.sim.memory import ControllerMemory
from fpcad.run.sim.states import NEXT

_PREFILL_US = 500_000
_START_WINDOW_US = (0, 60_000_000)
"""How far ahead of the controller's clock a Start may lie."""


def perform(controller: ControllerMemory, frame: Frame) -> Refused | None:
    """Carry out one sequenced command, or leave everything as it is and say why."""
    reason, joint = _attempt(controller, frame) or (None, 0)
    if reason is None:
        return None
    return Refused(frame.seq, frame.kind, reason, joint, controller.state, controller.cause)


def _attempt(controller: ControllerMemory, frame: Frame) -> tuple[Reason, int] | None:
    try:
        msg = decode(frame.kind, frame.payload)
    except MalformedMessage:
        return Reason.MALFORMED, 0
    following = NEXT.get((controller.state, type(msg)))
    if following is None:
        return Reason.WRONG_STATE, 0
    refusal = _act(controller, msg)
    if refusal is None:
        unhomed = following is State.READY and not controller.homed
        controller.state = State.IDLE if unhomed else following
    return refusal


def _act(controller: ControllerMemory, msg: Any) -> tuple[Reason, int] | None:
    if isinstance(msg, Knot):
        return controller.follower.offer(msg, controller.plant.position)
    if isinstance(msg, Start):
        return _schedule(controller, msg.device_us)
    if isinstance(msg, End):
        reason = controller.follower.end(msg.knots)
        return None if reason is None else (reason, 0)
    if isinstance(msg, Arm):
        controller.follower.forget()
    if isinstance(msg, Home):
        controller.homed, controller.homing = False, HomingOutcome.SEARCHING
        controller.plant.torque_on = True
        controller.tour = HomingTour(controller.setup.limits, controller.plant.position)
    if isinstance(msg, Calibrate):
        return _calibrate(controller, msg)
    if isinstance(msg, Clear):
        if controller.follower.rate > 0:
            return Reason.STILL_MOVING, 0
        controller.clear()
    return None


def _calibrate(controller: ControllerMemory, msg: Calibrate) -> tuple[Reason, int] | None:
    """Keep zeros that put each joint within its range, or a tenth of it beyond."""
    limits, gears = controller.setup.limits, controller.gears
    if len(msg.offset_urad) != len(limits.names):
        return Reason.MALFORMED, 0
    wrong = gears.offset_rad - from_counts(msg.offset_urad)
    joint = controller.plant.position + np.linalg.solve(gears.matrix, wrong)
    margin = (limits.upper_rad - limits.lower_rad) / 10
    outside = (joint < limits.lower_rad - margin) | (joint > limits.upper_rad + margin)
    if outside.any():
        return Reason.IMPLAUSIBLE, int(np.flatnonzero(outside)[0])
    controller.offset_urad = msg.offset_urad
    controller.homing = HomingOutcome.CALIBRATED
    controller.settle()
    return None


def _schedule(controller: ControllerMemory, device_us: int) -> tuple[Reason, int] | None:
    earliest, latest = _START_WINDOW_US
    if not earliest <= device_us - controller.time_us <= latest:
        return Reason.START_TIME, 0
    if controller.follower.queued_us < _PREFILL_US and not controller.follower.ended:
        return Reason.TOO_LITTLE_PREFILL, 0
    controller.start_us = device_us
    return None
