"""The firmware's servo buses from Python: their structures, and a line whose other end is Python."""

from __future__ import annotations

import ctypes
from collections.abc import Callable

from fpcad.run.messages import MAX_JOINTS

TRANSMIT = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.POINTER(ctypes.c_uint8), ctypes.c_uint8)
RECEIVE = ctypes.CFUNCTYPE(
    ctypes.c_uint8,
    ctypes.c_void_p,
    ctypes.POINTER(ctypes.c_uint8),
    ctypes.c_uint8,
    ctypes.c_uint16,
)


class Line(ctypes.Structure):
    """`struct bus_line` of core/half_duplex.h."""

    _fields_ = (("context", ctypes.c_void_p), ("transmit", TRANSMIT), ("receive", RECEIVE))


class Mount(ctypes.Structure):
    """`struct servo_mount`."""

    _fields_ = (("id", ctypes.c_uint8), ("sign", ctypes.c_int8), ("zero", ctypes.c_int16))


class Goals(ctypes.Structure):
    """`struct motor_goals` of core/board.h."""

    _fields_ = (
        ("position", ctypes.c_int32 * MAX_JOINTS),
        ("velocity", ctypes.c_int32 * MAX_JOINTS),
        ("torque_on", ctypes.c_bool),
        ("current_ma", ctypes.c_int16),
    )


class Readings(ctypes.Structure):
    """`struct motor_readings`."""

    _fields_ = (
        ("position", ctypes.c_int32 * MAX_JOINTS),
        ("current_ma", ctypes.c_int16 * MAX_JOINTS),
        ("temperature_c", ctypes.c_int8 * MAX_JOINTS),
        ("answered", ctypes.c_bool * MAX_JOINTS),
    )


def goals_at(angles_rad, *, torque_on=True, current_ma=0) -> Goals:
    """Goals of the first motors [rad]."""
    goals = Goals(torque_on=torque_on, current_ma=current_ma)
    goals.position[: len(angles_rad)] = [round(a * 1e6) for a in angles_rad]
    return goals


def line_to(hear: Callable[[bytes], None], say: Callable[[int], bytes]) -> Line:
    """A line: `hear` takes what the firmware sends, `say` gives at most so many bytes of answers."""

    def transmit(_context, data, count):
        hear(bytes(data[:count]))

    def receive(_context, out, room, _patience_us):
        said = say(room)
        ctypes.memmove(out, said, len(said))
        return len(said)

    return Line(None, TRANSMIT(transmit), RECEIVE(receive))
