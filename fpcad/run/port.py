"""Serial ports, with one clear error for each way in which one cannot be had."""

from __future__ import annotations

import errno
import termios
from typing import Protocol

import serial
from serial.tools import list_ports

from fpcad.run.errors import LinkLost, PortBusy, PortForbidden, PortMissing, PortUnusable, RunError

BAUD_RATE = 115_200
READ_WAIT_S = 0.005
"""Longest wait of one read: the host looks at its clock at least this often."""
_WRITE_TIMEOUT_S = 0.5
"""A stalled peer takes what the system buffers, then only this ends a write."""

_BUSY = (errno.EBUSY, errno.EWOULDBLOCK, errno.EAGAIN)
_MISSING = (errno.ENOENT, errno.ENXIO, errno.ENODEV)
_FORBIDDEN = (errno.EACCES, errno.EPERM)


class Transport(Protocol):
    """Bytes to and from a controller."""

    def read(self) -> bytes:
        """What has come, after a wait of at most `READ_WAIT_S` for the first byte."""
        ...

    def write(self, data: bytes) -> None:
        """Send all of `data`."""
        ...

    def close(self) -> None:
        """Give the line back."""
        ...


class SerialTransport:
    """A serial port through pyserial; broken lines raise :class:`LinkLost`."""

    def __init__(self, port: serial.Serial) -> None:
        self._port = port

    def read(self) -> bytes:
        try:
            first = self._port.read(1)
            return first + self._port.read(self._port.in_waiting) if first else first
        except (OSError, termios.error) as error:
            raise self._lost(error) from error

    def write(self, data: bytes) -> None:
        try:
            self._port.write(data)
        except (OSError, termios.error) as error:
            raise self._lost(error) from error

    def close(self) -> None:
        self._port.close()

    def _lost(self, error: Exception) -> LinkLost:
        return LinkLost(
            f"{self._port.name}: the line broke ({error}); was it unplugged, or the power lost?"
        )


def open_port(name: str, baud_rate: int = BAUD_RATE) -> SerialTransport:
    """Open a serial port for this program alone; raises a :class:`RunError` with advice."""
    return SerialTransport(open_serial(name, baud_rate, READ_WAIT_S))


def open_serial(name: str, baud_rate: int, read_wait_s: float) -> serial.Serial:
    """The port itself, whose reads wait `read_wait_s` [s] at most; errors as :func:`open_port`."""
    try:
        return serial.Serial(
            name,
            baud_rate,
            timeout=read_wait_s,
            write_timeout=_WRITE_TIMEOUT_S,
            exclusive=True,
        )
    except (OSError, termios.error, ValueError) as error:
        raise _opening_error(name, error) from error


def _opening_error(name: str, error: Exception) -> RunError:
    number = getattr(error, "errno", None)
    if number in _MISSING:
        return PortMissing(f"{name}: no such port; {_present_ports()}")
    if number in _FORBIDDEN:
        return PortForbidden(
            f"{name}: permission denied; add yourself to the group that owns serial ports "
            "(`sudo usermod -aG dialout $USER`) and log in again"
        )
    if number in _BUSY:
        return PortBusy(f"{name}: another program holds the port; close it and try again")
    return PortUnusable(f"{name}: is no serial port that can be used: {error}")


def _present_ports() -> str:
    names = sorted(port.device for port in list_ports.comports())
    return (
        f"present: {', '.join(names)}" if names else "no serial port is present; is it plugged in?"
    )
