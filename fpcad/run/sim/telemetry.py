"""What a controller tells of itself."""

from __future__ import annotations

import zlib

from fpcad.run.codec import encode
from fpcad.run.limits import COUNTS_PER_UNIT, to_counts
from fpcad.run.messages import (
    PRELOAD_URAD,
    Ack,
    Calibrate,
    Health,
    HomingOutcome,
    HomingReport,
    Telemetry,
    Welcome,
)
from fpcad.run.sim.memory import ControllerMemory

TICK_HZ = 250
_MA_PER_NM = 930
"""What a servo of 2.9 N m at 2.7 A draws."""
_AMBIENT_C = 25


def welcome(controller: ControllerMemory) -> Welcome:
    """Who answers."""
    setup = controller.setup
    return Welcome(
        setup.protocol,
        len(setup.limits.names),
        controller.state,
        controller.cause,
        TICK_HZ,
        setup.buffer_knots,
        setup.boot_nonce,
        setup.limits.hash(),
        int(controller.homed),
        zlib.crc32(encode(Calibrate(controller.offset_urad))) if controller.homed else 0,
        setup.build,
    )


def ack(controller: ControllerMemory) -> Ack:
    """Everything so far is done."""
    return Ack(controller.sequence.expected, controller.follower.free, controller.state)


def place(controller: ControllerMemory) -> Telemetry:
    """Where path and joints are, 50 times a second."""
    follower = controller.follower
    at_rest = controller.plant.torque_on
    return Telemetry(
        controller.time_us,
        follower.path_us,
        controller.state,
        controller.cause,
        round(1000 * follower.rate),
        follower.queued,
        controller.reader.bad_frames & 0xFFFF,
        to_counts(controller.plant.position),
        to_counts(follower.command if at_rest else controller.plant.position),
    )


def health(controller: ControllerMemory) -> Health:
    """How line and motors fare, ten times a second."""
    return Health(
        controller.time_us,
        controller.gaps & 0xFFFF,
        tuple(int(x) for x in controller.plant.torque * _MA_PER_NM),
        (_AMBIENT_C,) * len(controller.plant.position),
        tuple(round(x * COUNTS_PER_UNIT / PRELOAD_URAD) for x in controller.follower.preload),
    )


def homing_report(controller: ControllerMemory) -> HomingReport:
    """What homing has found so far."""
    limits = controller.setup.limits.on_wire()
    joints = len(limits.lower_urad)
    found = joints if controller.homing is HomingOutcome.FOUND else 0
    if controller.tour is not None and controller.homing is not HomingOutcome.CALIBRATED:
        found = joints if controller.tour.done else controller.tour.joint
    nothing = (0,) * (joints - found)
    return HomingReport(
        controller.homing,
        0 if controller.tour is None else controller.tour.joint,
        controller.offset_urad,
        limits.lower_urad[:found] + nothing,
        limits.upper_urad[:found] + nothing,
    )
