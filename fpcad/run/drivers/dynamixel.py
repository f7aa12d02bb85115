"""Dynamixel X servos (XL330, XC330) on Protocol 2.0, through ROBOTIS' own SDK."""

from __future__ import annotations

import math
from typing import ClassVar

from fpcad.errors import ToolchainError
from fpcad.run.drivers.registers import Registers
from fpcad.run.drivers.servo_types import Block, Reading, ServoModel
from fpcad.run.drivers.servos import ServoRegisterBus
from fpcad.run.errors import ServoFault, WatchdogTripped

_ID, _OPERATING_MODE, _HARDWARE_ERROR, _BUS_WATCHDOG, _GOAL_CURRENT = 7, 11, 70, 98, 102
_CURRENT_BASED_POSITION = 5
_WATCHDOG_STEP_S = 0.02
_TRIPPED = 0xFF
_ALERT = 0x80
_FAULTS = ("input voltage", "", "overheating", "encoder", "electrical shock", "overload")


class DynamixelBus(ServoRegisterBus):
    """Servos in current-based position mode, with the bus watchdog of the servos themselves."""

    without_host = "Its servos stop by themselves when their watchdog trips, and hold."
    models: ClassVar[dict[int, ServoModel]] = {
        1190: ServoModel("XL330-M077", 0.228, 1470),
        1200: ServoModel("XL330-M288", 0.52, 1470),
        1220: ServoModel("XC330-T288", 0.92, 800),
        1240: ServoModel("XC330-M288", 0.93, 1800),
    }
    firmware = Block(6, 1)
    state = Block(126, 21)  # current 126, velocity 128, position 132, voltage 144, temperature 146
    torque_enable = 64
    goal = Block(116, 4)
    goal_counts = (-1_048_575, 1_048_575)  # 256 turns either way

    _patience_s = math.inf
    _spoke_s = 0.0

    def watchdog(self, timeout_s: float) -> bool:
        steps = math.ceil(timeout_s / _WATCHDOG_STEP_S)
        if not 1 <= steps <= 127:
            raise ValueError(f"a watchdog of {timeout_s:g} s: 0.02 to 2.54 s are possible")
        self._patience_s = math.inf
        self._set_all(_BUS_WATCHDOG, bytes(1), "its watchdog")  # clears one that has tripped
        self._set_all(_BUS_WATCHDOG, bytes([steps]), "its watchdog")
        self._spoke_s, self._patience_s = self._clock(), timeout_s
        return True

    def limit_torque(self, share: float) -> None:
        current = round(share * self._wanted.stall_ma)
        self._set_all(_GOAL_CURRENT, current.to_bytes(2, "little"), "its current limit")

    def torque(self, on: bool) -> None:
        if not on:
            self._patience_s = math.inf
            self._set_all(_BUS_WATCHDOG, bytes(1), "its watchdog")
        super().torque(on)

    def _connect(self) -> Registers:
        try:
            import dynamixel_sdk
        except ModuleNotFoundError as error:
            raise ToolchainError(
                "the dynamixel driver needs ROBOTIS' SDK: pip install 'fpcad[dynamixel]'"
            ) from error
        packets = dynamixel_sdk.PacketHandler(2.0)
        return Registers(dynamixel_sdk, packets, self._port, self._baud_rate, self.without_host)

    def _prepare(self) -> None:
        self._set_all(_BUS_WATCHDOG, bytes(1), "its watchdog")
        modes = self._read_all_certainly(Block(_OPERATING_MODE, 1))
        other = [n for n in self.numbers if modes[n][0] != _CURRENT_BASED_POSITION]
        for number in other:  # kept in a memory that wears out, so only where it differs
            self._line.write(number, self.torque_enable, b"\0")
            self._line.write(number, _OPERATING_MODE, bytes([_CURRENT_BASED_POSITION]))

    def _decode(self, data: bytes) -> Reading:
        return Reading(
            int.from_bytes(data[6:10], "little", signed=True),
            abs(int.from_bytes(data[0:2], "little", signed=True)),
            float(data[20]),
        )

    def _alert(self, number: int, error: int) -> str | None:
        if not error & _ALERT:
            return None
        status = self._line.read(number, _HARDWARE_ERROR, 1)
        bits = status[0] if status else 0
        names = [name for i, name in enumerate(_FAULTS) if bits >> i & 1 and name]
        return f"reports {', '.join(names) or 'a fault'}; let it cool, then switch its power off and on"

    def _renumber(self, old: int, new: int) -> None:
        self._line.write(old, _ID, bytes([new]))

    def _watch(self) -> None:
        """After a long silence the servos may have stopped, and then take no goals any more."""
        now = self._clock()
        silence_s, self._spoke_s = now - self._spoke_s, now
        if silence_s < 0.5 * self._patience_s:
            return
        values = self._read_all_certainly(Block(_BUS_WATCHDOG, 1))
        if any(value[0] == _TRIPPED for value in values.values()):
            raise WatchdogTripped(
                f"the servos heard nothing for {silence_s:.2f} s and stopped by themselves; start anew"
            )

    def _set_all(self, address: int, data: bytes, what: str) -> None:
        """Set a register of all servos and make sure that they took it."""
        self._line.write_all(address, dict.fromkeys(self.numbers, data))
        values = self._read_all_certainly(Block(address, len(data)))
        for name, number in zip(self.names, self.numbers, strict=True):
            if values[number] != data:
                raise ServoFault(f"{self._called(name, number)} did not take {what}")
