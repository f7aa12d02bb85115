"""The handshake: who answers, does it speak our protocol, and is it set up for this hand?"""

from __future__ import annotations

import secrets
import time

from fpcad.run.errors import (
    ConfigurationMismatch,
    ControllerSilent,
    JointMismatch,
    ProtocolMismatch,
)
from fpcad.run.framing import DELIMITER, PROTOCOL_VERSION
from fpcad.run.limits import JointLimits, from_counts
from fpcad.run.link import Clock, Link
from fpcad.run.messages import AskLimits, Hello, Limits, Welcome
from fpcad.run.port import Transport

HANDSHAKE_S = 5.0
"""Patience with a controller that boots: opening a port may reset the board."""
_RETRY_S = 0.2


def handshake(
    transport: Transport,
    limits: JointLimits,
    clock: Clock = time.monotonic,
    patience_s: float = HANDSHAKE_S,
) -> tuple[Link, Welcome]:
    """Open a session with a controller that fits; raises before anything could move."""
    link = Link(transport, secrets.randbelow(0xFFFF) + 1, clock)
    transport.write(DELIMITER)  # ends whatever the controller has half received
    welcome = _ask(link, Hello(), Welcome, patience_s)
    if welcome is None:
        raise _silence(link, patience_s)
    if welcome.protocol != PROTOCOL_VERSION:
        raise _other_protocol(welcome.protocol)
    if welcome.joints != len(limits.names):
        raise JointMismatch(
            f"the controller drives {welcome.joints} joints, the trajectory {len(limits.names)}"
        )
    if welcome.configuration != limits.hash():
        raise _other_configuration(link, limits, patience_s)
    link.watch_silence = True
    link.heard_at_s = clock()
    return link, welcome


def _ask(link: Link, question: Hello | AskLimits, answer: type, patience_s: float):
    deadline = link.clock() + patience_s
    asked_at = float("-inf")
    while link.clock() < deadline and link.foreign_version is None:
        if link.clock() - asked_at >= _RETRY_S:
            asked_at = link.clock()
            link.send_now(question)
        for msg in link.poll():
            if isinstance(msg, answer):
                return msg
    return None


def _silence(link: Link, patience_s: float) -> ControllerSilent | ProtocolMismatch:
    if link.foreign_version is not None:
        return _other_protocol(link.foreign_version)
    if link.reader.bytes_read == 0:
        return ControllerSilent(
            f"no answer within {patience_s:g} s; is the controller powered and its firmware loaded?"
        )
    return ControllerSilent(
        f"{link.reader.bytes_read} bytes came within {patience_s:g} s, but no valid frame; "
        "is this another device, or another baud rate?"
    )


def _other_protocol(version: int) -> ProtocolMismatch:
    return ProtocolMismatch(
        f"the controller speaks protocol version {version}, this program {PROTOCOL_VERSION}; "
        "update the older one"
    )


def _other_configuration(
    link: Link, limits: JointLimits, patience_s: float
) -> ConfigurationMismatch:
    """Say what differs, as far as the controller tells."""
    theirs = _ask(link, AskLimits(), Limits, patience_s)
    ours = limits.on_wire()
    detail = "names, transmission or calibration differ"
    if theirs is not None and theirs != ours:
        detail = _first_difference(limits.names, ours, theirs)
    return ConfigurationMismatch(
        f"the controller is set up for another hand: {detail}; load the set-up of this build"
    )


def _first_difference(names: tuple[str, ...], ours: Limits, theirs: Limits) -> str:
    for field in ("lower_urad", "upper_urad", "velocity_urad_s", "acceleration_urad_s2"):
        mine, yours = from_counts(getattr(ours, field)), from_counts(getattr(theirs, field))
        for name, here, there in zip(names, mine, yours, strict=True):
            if here != there:
                quantity = field.split("_")[0]
                return f"{name}: {quantity} limit {there:g} there, {here:g} here (rad, s)"
    return "names, transmission or calibration differ"
