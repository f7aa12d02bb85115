"""A bus of servos with registers, spoken to through a maker's SDK, whose faults end here.

The SDKs of both makers descend from one source: same classes, same calls, other packets. What they
leave to be desired is mended in this file: ports are opened for one program alone, replies that
their parsers trip over count as unreadable, and one silent servo does not hide the others' answers.
"""

from __future__ import annotations

import termios
from types import ModuleType
from typing import Any

import serial

from fpcad.run.errors import LinkLost
from fpcad.run.port import open_serial

_READ_WAIT_S = 0.002
"""Longest wait of one read; the SDKs would spin instead."""


class Registers:
    """Servos on one line, by id, address and bytes. A servo that does not answer reads as None."""

    def __init__(
        self, sdk: ModuleType, packets: Any, port: str, baud_rate: int, without_host: str
    ) -> None:
        self._sdk, self._packets, self.port = sdk, packets, port
        self._without_host = without_host
        self._line = _line(sdk, port, baud_rate)
        self.unreadable = 0
        """Answers that could not be read."""
        self.alerts: dict[int, int] = {}
        """Error bytes other than 0 of the latest answers, by id."""

    def ping(self, number: int) -> int | None:
        """Model number of the servo with this id."""
        model, result, _ = self._call(self._packets.ping, self._line, number)
        return model if self._good(result) else None

    def read(self, number: int, address: int, length: int) -> bytes | None:
        """Registers of one servo."""
        data, result, error = self._call(
            self._packets.readTxRx, self._line, number, address, length
        )
        return self._noted(number, data, result, error, length)

    def write(self, number: int, address: int, data: bytes) -> bool:
        """Set registers of one servo; whether it said that it did."""
        result, error = self._call(
            self._packets.writeTxRx, self._line, number, address, len(data), list(data), parts=2
        )
        if result == self._sdk.COMM_SUCCESS and error:
            self.alerts[number] = error
        return self._good(result) and not error

    def read_all(self, numbers: tuple[int, ...], address: int, length: int) -> dict[int, bytes]:
        """The same registers of all servos in one exchange; those that answered."""
        asked = self._sdk.GroupSyncRead(self._line, self._packets, address, length)
        for number in numbers:
            asked.addParam(number)
        if not self._good(self._call(asked.txPacket, parts=1)[0]):
            return {}
        answers = {}
        for number in numbers:
            data, result, error = self._call(self._packets.readRx, self._line, number, length)
            noted = self._noted(number, data, result, error, length)
            if noted is None:
                break  # servos answer in turn, each after the one before it
            answers[number] = noted
        return answers

    def write_all(self, address: int, data: dict[int, bytes]) -> None:
        """Set registers of many servos in one frame that nobody answers."""
        length = len(next(iter(data.values())))
        told = self._sdk.GroupSyncWrite(self._line, self._packets, address, length)
        for number, value in data.items():
            told.addParam(number, list(value))
        if not self._good(self._call(told.txPacket, parts=1)[0]):
            raise self._lost("nothing could be sent")

    def close(self) -> None:
        """Give the port back; twice does no harm."""
        self._line.ser.close()

    def _noted(self, number: int, data: Any, result: int, error: int, length: int) -> bytes | None:
        if not self._good(result):
            return None
        self.alerts.pop(number, None)
        if error:
            self.alerts[number] = error
        if len(data) != length:  # an answer with an error may carry no data
            self.unreadable += 1
            return None
        return bytes(data)

    def _good(self, result: int) -> bool:
        self.unreadable += result == self._sdk.COMM_RX_CORRUPT
        return result == self._sdk.COMM_SUCCESS

    def _call(self, function: Any, *arguments: Any, parts: int = 3) -> tuple[Any, ...]:
        """The SDK's answer as `parts` values, of which the second last, or only one, is its result."""
        try:
            answer = function(*arguments)
        except (OSError, termios.error) as error:  # serial's own exceptions are OSErrors
            raise self._lost(str(error)) from error
        except (IndexError, TypeError, ValueError, KeyError):
            # Replies that were damaged on the way trip the SDKs' parsers.
            self._line.is_using = False
            corrupt = self._sdk.COMM_RX_CORRUPT
            answer = {1: corrupt, 2: (corrupt, 0), 3: ([], corrupt, 0)}[parts]
        return answer if parts > 1 else (answer,)

    def _lost(self, why: str) -> LinkLost:
        error = LinkLost(f"{self.port}: the line broke ({why}); was the adapter unplugged?")
        return error.leaving(self._without_host)


def _line(sdk: ModuleType, port: str, baud_rate: int) -> Any:
    class Line(sdk.PortHandler):  # type: ignore[name-defined]
        """The SDK's port, opened as ours are."""

        ser: serial.Serial

        def setupPort(self, cflag_baud: int) -> bool:
            self.ser = open_serial(self.port_name, cflag_baud, _READ_WAIT_S)
            _hurry(self.ser)
            self.is_open = True
            self.tx_time_per_byte = 10_000.0 / cflag_baud  # [ms]
            return True

        def clearPort(self) -> None:
            self.ser.reset_input_buffer()  # late answers to what was asked before

    line = Line(port)
    line.baudrate = baud_rate
    line.setupPort(baud_rate)
    return line


def _hurry(port: serial.Serial) -> None:
    """Ask a USB adapter not to collect bytes for 16 ms; those that cannot are as quick as they are."""
    try:
        port.set_low_latency_mode(True)
    except (ValueError, NotImplementedError, OSError):
        return
