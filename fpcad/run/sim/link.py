"""The controller's sessions: which frame is for it, who is answered, and what waits for what."""

from __future__ import annotations

from functools import partial
from typing import Any

from fpcad.run.codec import CLASSES, KINDS, MalformedMessage, decode, encode
from fpcad.run.framing import Frame, encode_frame
from fpcad.run.messages import (
    AskHoming,
    AskLimits,
    Cause,
    Estop,
    Hello,
    Hold,
    Nak,
    NoSession,
    Ping,
    Pong,
    State,
)
from fpcad.run.sim import commands, telemetry
from fpcad.run.sim.memory import ControllerMemory
from fpcad.run.sim.sequence import DONE, Sequence
from fpcad.run.sim.states import NEXT


def take(controller: ControllerMemory, frame: Frame) -> None:
    """Act on one good frame, and answer it."""
    cls = CLASSES.get(frame.kind)
    if cls is Hello:
        _greet(controller, frame)
    elif frame.version != controller.setup.protocol or cls is None or frame.kind >= 0x40:
        return
    elif cls is Estop:
        controller.halt()
        send(controller, telemetry.ack(controller), frame.session)
    elif frame.session != controller.session or not controller.session:
        send(controller, NoSession(controller.setup.boot_nonce), frame.session)
    else:
        controller.heard_us = controller.time_us
        _obey(controller, frame, cls)


def _greet(controller: ControllerMemory, frame: Frame) -> None:
    if frame.session != controller.session and not controller.moving:
        controller.session, controller.sequence = frame.session, Sequence()
        controller.heard_us = controller.time_us
        if controller.state is State.ARMED:
            controller.state = State.READY
    send(controller, telemetry.welcome(controller), frame.session)


def _obey(controller: ControllerMemory, frame: Frame, cls: type) -> None:
    if KINDS[cls].sequenced:
        reply = controller.sequence.take(frame, partial(commands.perform, controller))
        controller.gaps += isinstance(reply, Nak)
        if reply is not None:
            send(controller, telemetry.ack(controller) if reply is DONE else reply)
        return
    try:
        msg = decode(frame.kind, frame.payload)
    except MalformedMessage:
        controller.reader.bad_frames += 1
        return
    if isinstance(msg, Ping):
        send(controller, Pong(msg.host_us, controller.time_us))
    elif isinstance(msg, AskLimits):
        send(controller, controller.setup.limits.on_wire())
    elif isinstance(msg, AskHoming):
        send(controller, telemetry.homing_report(controller))
    elif isinstance(msg, Hold):
        if controller.state is State.HOMING:
            controller.stop_homing()
        if NEXT[controller.state, Hold] is not controller.state:
            controller.stop(NEXT[controller.state, Hold], Cause.HOST)
        send(controller, telemetry.ack(controller))


def send(controller: ControllerMemory, msg: Any, session: int | None = None) -> None:
    """Put a message out, for the session that there is, or for another one."""
    kind = KINDS[type(msg)]
    controller.output += encode_frame(
        Frame(
            kind.code,
            0,
            controller.session if session is None else session,
            encode(msg),
            controller.setup.protocol,
        )
    )
