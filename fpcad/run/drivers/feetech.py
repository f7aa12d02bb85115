"""Feetech STS3215 servos, through the SDK that bears the maker's name.

These servos have no watchdog: when the host dies, they keep pulling towards their last goal. Use the
project's firmware between host and servos where that must not be.
"""

from __future__ import annotations

from typing import ClassVar

from fpcad.errors import ToolchainError
from fpcad.run.drivers.registers import Registers
from fpcad.run.drivers.servo_types import Block, Reading, ServoModel
from fpcad.run.drivers.servos import ServoRegisterBus
from fpcad.run.errors import ServoFault

_ID, _MODE, _TORQUE_LIMIT, _LOCK = 5, 33, 48, 55
_POSITION_MODE = 0
_MA_PER_COUNT = 6.5
_SIGN = 0x8000
_FAULTS = {1: "input voltage", 2: "encoder", 4: "overheating", 8: "overcurrent", 32: "overload"}


class FeetechBus(ServoRegisterBus):
    """Servos in position mode."""

    without_host = (
        "Its servos keep their last goal, for they have no watchdog; cut their power if need be."
    )
    models: ClassVar[dict[int, ServoModel]] = {777: ServoModel("STS3215", 2.94, 2700)}
    firmware = Block(0, 2)
    state = Block(56, 15)  # position 56, speed 58, load 60, voltage 62, temperature 63, current 69
    torque_enable = 40
    goal = Block(42, 2)
    goal_counts = (0, 4095)

    def watchdog(self, timeout_s: float) -> bool:
        """There is none: always False."""
        return False

    def limit_torque(self, share: float) -> None:
        data = round(1000 * share).to_bytes(2, "little")
        self._line.write_all(_TORQUE_LIMIT, dict.fromkeys(self.numbers, data))
        values = self._read_all_certainly(Block(_TORQUE_LIMIT, 2))
        for name, number in zip(self.names, self.numbers, strict=True):
            if values[number] != data:
                raise ServoFault(f"{self._called(name, number)} did not take its torque limit")

    def _connect(self) -> Registers:
        try:
            import scservo_sdk
        except ModuleNotFoundError as error:
            raise ToolchainError(
                "the feetech driver needs the servos' SDK: pip install 'fpcad[feetech]'"
            ) from error
        packets = scservo_sdk.PacketHandler(0)  # 0: the byte order of the STS series
        return Registers(scservo_sdk, packets, self._port, self._baud_rate, self.without_host)

    def _decode(self, data: bytes) -> Reading:
        return Reading(
            _signed(data[0:2]), abs(_signed(data[13:15])) * _MA_PER_COUNT, float(data[7])
        )

    def _alert(self, number: int, error: int) -> str | None:
        names = [name for bit, name in _FAULTS.items() if error & bit]
        return f"reports {', '.join(names)}; let it cool and take the load away" if names else None

    def _prepare(self) -> None:
        modes = self._read_all_certainly(Block(_MODE, 1))
        for name, number in zip(self.names, self.numbers, strict=True):
            if modes[number][0] != _POSITION_MODE:
                raise ServoFault(
                    f"{self._called(name, number)} is not in position mode; set its register 33 to 0"
                )

    def _watch(self) -> None:
        return  # without a watchdog there is none to look after

    def _renumber(self, old: int, new: int) -> None:
        self._line.write(old, _LOCK, b"\0")
        self._line.write(old, _ID, bytes([new]))
        self._line.write(new, _LOCK, b"\1")


def _signed(data: bytes) -> int:
    """Two bytes whose highest bit is a sign."""
    value = int.from_bytes(data, "little")
    return -(value & ~_SIGN) if value & _SIGN else value
