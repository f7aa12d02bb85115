"""The one definition of all messages: type bytes, fields and their places on the wire."""

from __future__ import annotations

from enum import IntEnum

from fpcad.run.codec import message, wire
from fpcad.run.framing import MAX_PAYLOAD

Urads = tuple[int, ...]
"""One fixed-point number a joint: urad, urad/s or urad/s^2."""

MAX_JOINTS = MAX_PAYLOAD // 16
"""Joints whose limits (four numbers each) fit in one payload."""

PRELOAD_URAD = 20
"""Preload travels in counts of so many 1e-6 rad: 16 bits then reach 0.65 rad."""


class State(IntEnum):
    """What a controller is doing."""

    BOOT = 0
    IDLE = 1
    HOMING = 2
    READY = 3
    ARMED = 4
    RUNNING = 5
    HOLD = 6
    FAULT = 7
    ESTOP = 8


class Cause(IntEnum):
    """Why a controller is in HOLD, FAULT or ESTOP."""

    NONE = 0
    HOST = 1
    SILENCE = 2
    UNDERRUN = 3
    TRACKING = 4
    CURRENT = 5
    TEMPERATURE = 6
    MOTOR_LOST = 7
    SWITCH = 8
    HOMING = 9


class HomingOutcome(IntEnum):
    """How the search for the joints' zeros ended, or where the zeros in use come from."""

    NEVER = 0
    SEARCHING = 1
    FOUND = 2
    NO_END = 3
    WRONG_RANGE = 4
    WRONG_SIGN = 5
    STOPPED = 6
    CALIBRATED = 7


class Reason(IntEnum):
    """Why a controller refuses a command."""

    WRONG_STATE = 1
    MALFORMED = 2
    BUFFER_FULL = 3
    TIME_NOT_INCREASING = 4
    LATE = 5
    NOT_AT_REST = 6
    TOO_FAR_FROM_START = 7
    POSITION_LIMIT = 8
    VELOCITY_LIMIT = 9
    ACCELERATION_LIMIT = 10
    TOO_LITTLE_PREFILL = 11
    START_TIME = 12
    KNOT_COUNT = 13
    STILL_MOVING = 14
    SEGMENT_TIME = 15
    PRELOAD_LIMIT = 16
    MOTOR_POSITION_LIMIT = 17
    MOTOR_VELOCITY_LIMIT = 18
    MOTOR_ACCELERATION_LIMIT = 19
    IMPLAUSIBLE = 20


@message(0x01)
class Hello:
    """Host: opens the session named in the header. Answer: Welcome."""


@message(0x02)
class AskLimits:
    """Host: asks for the joints' limits. Answer: Limits."""


@message(0x03)
class Ping:
    """Host: I am here. Answer: Pong."""

    host_us: int = wire("Q")


@message(0x04)
class Hold:
    """Host: decelerate along the path and hold, latched. Acted on at receipt. Answer: Ack."""


@message(0x05)
class Estop:
    """Host: torque off, latched. Acted on at receipt, in any session. Answer: Ack."""


@message(0x06)
class AskHoming:
    """Host: asks for what homing has found. Answer: HomingReport."""


@message(0x10, sequenced=True)
class Arm:
    """Host: READY to ARMED; empties the queue of knots."""


@message(0x11, sequenced=True)
class Knot:
    """Host: where the joints are at path time `t_us`; quintic Hermite in between.

    `preload_20urad` is put upon the position as the motors' goals, linear in between: what stretches
    the tendons for a grip. Position limits do not count it; it has a bound and a rate of its own.
    """

    t_us: int = wire("Q")
    position_urad: Urads = wire("i", per_joint=True)
    velocity_urad_s: Urads = wire("i", per_joint=True)
    acceleration_urad_s2: Urads = wire("i", per_joint=True)
    preload_20urad: tuple[int, ...] = wire("h", per_joint=True)


@message(0x12, sequenced=True)
class Start:
    """Host: path time 0 is at this time of the controller's clock."""

    device_us: int = wire("Q")


@message(0x13, sequenced=True)
class End:
    """Host: no knot follows; `knots` were sent since Arm."""

    knots: int = wire("I")


@message(0x14, sequenced=True)
class Clear:
    """Host: leave HOLD, FAULT or ESTOP; the goal becomes the present position."""


@message(0x15, sequenced=True)
class Home:
    """Host: find the joints' ends with little current, IDLE or READY to HOMING, then READY."""


@message(0x16, sequenced=True)
class Calibrate:
    """Host: the motors' zeros as measured before; motor = transmission * joint + offset."""

    offset_urad: Urads = wire("i", per_joint=True)


@message(0x40)
class Welcome:
    """Controller: who I am.

    `configuration` is the hash of limits and transmission; `homed` is 1 when the motors' zeros are
    known, and `calibration` is then the CRC-32 of them, as the payload of a Calibrate.
    """

    protocol: int = wire("B")
    joints: int = wire("B")
    state: int = wire("B")
    cause: int = wire("B")
    tick_hz: int = wire("H")
    buffer_knots: int = wire("H")
    boot_nonce: int = wire("I")
    configuration: int = wire("Q")
    homed: int = wire("B")
    calibration: int = wire("I")
    build: bytes = wire("16s")


@message(0x41)
class Limits:
    """Controller: the limits that it enforces."""

    lower_urad: Urads = wire("i", per_joint=True)
    upper_urad: Urads = wire("i", per_joint=True)
    velocity_urad_s: Urads = wire("i", per_joint=True)
    acceleration_urad_s2: Urads = wire("i", per_joint=True)


@message(0x42)
class Pong:
    """Controller: answer to a Ping, with its clock."""

    host_us: int = wire("Q")
    device_us: int = wire("Q")


@message(0x43)
class Ack:
    """Controller: everything before `expected` is done; there is room for `free_knots`."""

    expected: int = wire("H")
    free_knots: int = wire("H")
    state: int = wire("B")


@message(0x44)
class Nak:
    """Controller: a gap; send again from `expected`. Once a gap."""

    expected: int = wire("H")


@message(0x45)
class Refused:
    """Controller: sequenced frame `seq` and all behind it are not done, until the next Hello."""

    seq: int = wire("H")
    command: int = wire("B")
    reason: int = wire("B")
    joint: int = wire("B")
    state: int = wire("B")
    cause: int = wire("B")


@message(0x46)
class NoSession:
    """Controller: I do not know your session, for I restarted or serve another host."""

    boot_nonce: int = wire("I")


@message(0x47)
class Telemetry:
    """Controller, unasked: its state; `rate_permille` is 1000 at full speed along the path."""

    device_us: int = wire("Q")
    path_us: int = wire("Q")
    state: int = wire("B")
    cause: int = wire("B")
    rate_permille: int = wire("H")
    queued_knots: int = wire("H")
    bad_frames: int = wire("H")
    position_urad: Urads = wire("i", per_joint=True)
    command_urad: Urads = wire("i", per_joint=True)


@message(0x48)
class Health:
    """Controller, unasked, 10 times a second: its motors, the gaps in what it heard, the preload."""

    device_us: int = wire("Q")
    gaps: int = wire("H")
    current_ma: tuple[int, ...] = wire("h", per_joint=True)
    temperature_c: tuple[int, ...] = wire("b", per_joint=True)
    preload_20urad: tuple[int, ...] = wire("h", per_joint=True)


@message(0x49)
class HomingReport:
    """Controller: how homing ended (a HomingOutcome), at which joint, and what it found.

    `offset_urad` are the motors' zeros in use; `lower_urad` and `upper_urad` the joints' ends as
    found in the last search, counted from these zeros, and 0 for those not searched yet.
    """

    outcome: int = wire("B")
    joint: int = wire("B")
    offset_urad: Urads = wire("i", per_joint=True)
    lower_urad: Urads = wire("i", per_joint=True)
    upper_urad: Urads = wire("i", per_joint=True)
