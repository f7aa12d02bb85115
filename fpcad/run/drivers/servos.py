"""What all servo buses share: who is there, torque without a jump, and who fell silent."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from typing import ClassVar, Self, TypeVar

import numpy as np
from numpy.typing import NDArray

from fpcad.run.bus import BusState, Identity, checked_goals
from fpcad.run.drivers.registers import Registers
from fpcad.run.drivers.servo_types import Block, Reading, ServoModel
from fpcad.run.errors import PortMissing, ServoFault, ServoMismatch, ServoSilent
from fpcad.run.link import Clock

Array = NDArray[np.float64]
Fault = TypeVar("Fault", ServoFault, ServoSilent)

COUNTS_PER_TURN = 4096
MIDDLE_COUNTS = 2048
RAD_PER_COUNT = 2 * np.pi / COUNTS_PER_TURN
_MISSES = 2
"""Cycles without an answer after which a servo counts as dead."""
_PULLING = "Its other servos hold their last goals."
_SCANNED = 20
"""Ids that are tried when one is missing, to tell which there are."""


class ServoRegisterBus(ABC):
    """Servos with ids `numbers` for axes `names`; a maker fills in its registers."""

    without_host: str
    models: ClassVar[dict[int, ServoModel]]
    firmware: Block
    state: Block
    torque_enable: int
    goal: Block
    goal_counts: tuple[int, int]
    """Least and greatest goal."""

    def __init__(
        self,
        names: tuple[str, ...],
        numbers: tuple[int, ...],
        model: str,
        port: str,
        baud_rate: int,
        clock: Clock = time.monotonic,
    ) -> None:
        self.names, self.numbers = names, numbers
        self._port, self._baud_rate, self._clock = port, baud_rate, clock
        self._wanted = next(m for m in self.models.values() if m.name == model)
        self._registers: Registers | None = None
        self._latest: dict[int, Reading] = {}
        self._misses: dict[int, int] = {}
        self._on = False

    @property
    def torque_per_ma(self) -> float:
        """Torque of a motor for each mA [N m / mA]; its data sheet's stall values."""
        return self._wanted.stall_nm / self._wanted.stall_ma

    @property
    def goal_range_rad(self) -> tuple[float, float]:
        """Least and greatest goal; beyond lies the end of the encoder."""
        low, high = self.goal_counts
        return (low - MIDDLE_COUNTS) * RAD_PER_COUNT, (high - MIDDLE_COUNTS) * RAD_PER_COUNT

    def open(self) -> None:
        self._registers = self._connect()
        try:
            self.identify()
        except BaseException:
            self.close()
            raise

    def connect_only(self) -> Self:
        """Open the port whoever is there: to look for servos and to number them."""
        self._registers = self._connect()
        return self

    def identify(self) -> tuple[Identity, ...]:
        found = [self._identity(name, n) for name, n in zip(self.names, self.numbers, strict=True)]
        return tuple(found)

    def read_state(self) -> BusState:
        self._watch()
        answers = self._line.read_all(self.numbers, self.state.address, self.state.length)
        for number, data in answers.items():
            self._latest[number] = self._decode(data)
        self._count_misses(answers)
        self._require_sound()
        readings = [self._latest[number] for number in self.numbers]
        return BusState(
            np.array([r.counts - MIDDLE_COUNTS for r in readings]) * RAD_PER_COUNT,
            np.array([r.current_ma for r in readings]),
            np.array([r.temperature_c for r in readings]),
            self._on,
            self._line.unreadable,
        )

    def write_goals(self, goal_rad: Array) -> None:
        goal = checked_goals(self.names, goal_rad, *self.goal_range_rad)
        self._watch()
        self._send_goals(np.rint(goal / RAD_PER_COUNT).astype(int) + MIDDLE_COUNTS)

    def torque(self, on: bool) -> None:
        if on and not self._on:
            self._prepare()
            self._misses.clear()
            self._latest.clear()
            present = self._read_all_certainly(self.state)
            counts = np.array([self._decode(present[n]).counts for n in self.numbers])
            self._send_goals(counts)
            self._require_goals(counts)
        self._line.write_all(self.torque_enable, {n: bytes([on]) for n in self.numbers})
        flags = self._read_all_certainly(Block(self.torque_enable, 1))
        for name, number in zip(self.names, self.numbers, strict=True):
            if bool(flags[number][0]) != on:
                verb = "on" if on else "off"
                raise self._told(
                    ServoFault(f"{self._called(name, number)} did not turn its torque {verb}")
                )
        self._on = on

    @abstractmethod
    def watchdog(self, timeout_s: float) -> bool: ...

    @abstractmethod
    def limit_torque(self, share: float) -> None: ...

    def close(self) -> None:
        if self._registers is not None:
            self._registers.close()
            self._registers = None

    def assign(self, old: int, new: int) -> None:
        """Give the servo with id `old` the id `new`, for good; torque is off afterwards."""
        if self._line.ping(old) is None:
            raise self._missing(f"id {old}", old)
        if self._line.ping(new) is not None:
            raise ServoMismatch(
                f"{self._port}: id {new} is taken; unplug that servo, or use another id"
            )
        self._line.write(old, self.torque_enable, b"\0")
        self._renumber(old, new)
        if self._line.ping(new) is None:
            raise ServoSilent(f"{self._port}: the servo does not answer to its new id {new}")

    def scan(self, numbers: range) -> dict[int, str]:
        """Servos that answer, by id."""
        found = {n: model for n in numbers if (model := self._line.ping(n)) is not None}
        return {n: self._model_name(model) for n, model in found.items()}

    @abstractmethod
    def _connect(self) -> Registers: ...

    @abstractmethod
    def _decode(self, data: bytes) -> Reading: ...

    @abstractmethod
    def _alert(self, number: int, error: int) -> str | None:
        """What a servo complains of, or None for nothing that matters."""

    @abstractmethod
    def _renumber(self, old: int, new: int) -> None: ...

    @abstractmethod
    def _prepare(self) -> None:
        """Bring servos into the mode that is needed, torque still off."""

    @abstractmethod
    def _watch(self) -> None:
        """Look after a watchdog that may have tripped."""

    @property
    def _line(self) -> Registers:
        if self._registers is None:
            raise PortMissing(f"{self._port}: the bus is closed; open it first")
        return self._registers

    def _send_goals(self, counts: NDArray[np.signedinteger]) -> None:
        size = self.goal.length
        self._line.write_all(
            self.goal.address,
            {
                n: int(c).to_bytes(size, "little", signed=size == 4)
                for n, c in zip(self.numbers, counts, strict=True)
            },
        )

    def _require_goals(self, counts: NDArray[np.signedinteger]) -> None:
        """Torque comes only when each servo says that its goal is where it is."""
        size = self.goal.length
        goals = self._read_all_certainly(self.goal)
        for name, number, count in zip(self.names, self.numbers, counts, strict=True):
            goal = int.from_bytes(goals[number], "little", signed=size == 4)
            if goal != count:
                raise ServoFault(
                    f"{self._called(name, number)} kept the goal {goal} though it was told {count}, "
                    "where it is; torque stays off, look at its limits"
                )

    def _read_all_certainly(self, block: Block) -> dict[int, bytes]:
        """Registers of every servo, asked one by one where the common question failed."""
        answers = self._line.read_all(self.numbers, block.address, block.length)
        for name, number in zip(self.names, self.numbers, strict=True):
            if number not in answers:
                answers[number] = self._ask(name, number, block)
        return answers

    def _ask(self, name: str, number: int, block: Block, tries: int = 3) -> bytes:
        for _ in range(tries):
            data = self._line.read(number, block.address, block.length)
            if data is not None:
                return data
        raise self._missing(name, number)

    def _count_misses(self, answers: dict[int, bytes]) -> None:
        """A reading may be lost once; the servo that stays silent is named."""
        silent = next((n for n in self.numbers if n not in answers), None)
        self._misses = {} if silent is None else {silent: self._misses.get(silent, 0) + 1}
        if silent is None:
            return
        name = self.names[self.numbers.index(silent)]
        unknown = any(n not in self._latest for n in self.numbers)
        if unknown or self._misses[silent] >= _MISSES:
            tries = 3 if unknown else 1
            self._latest[silent] = self._decode(self._ask(name, silent, self.state, tries))
            self._misses = {}
        if unknown:
            for other, number in zip(self.names, self.numbers, strict=True):
                if number not in self._latest:
                    self._latest[number] = self._decode(self._ask(other, number, self.state))

    def _require_sound(self) -> None:
        for number, error in self._line.alerts.items():
            complaint = self._alert(number, error)
            if complaint is not None:
                name = self.names[self.numbers.index(number)]
                raise self._told(ServoFault(f"{self._called(name, number)}: {complaint}"))

    def _identity(self, name: str, number: int) -> Identity:
        model = next((m for _ in range(2) if (m := self._line.ping(number)) is not None), None)
        if model is None:
            raise self._missing(name, number)
        if self._model_name(model) != self._wanted.name:
            raise ServoMismatch(
                f"{self._called(name, number)} is a {self._model_name(model)}, the design wants "
                f"{self._wanted.name}; correct `motors:` in the design, or the ids"
            )
        version = self._ask(name, number, self.firmware)
        return Identity(name, number, self._model_name(model), ".".join(map(str, version)))

    def _model_name(self, model: int) -> str:
        known = self.models.get(model)
        return f"servo of model number {model}" if known is None else known.name

    def _called(self, name: str, number: int) -> str:
        return f"{name} (id {number} on {self._port})"

    def _missing(self, name: str, number: int) -> ServoSilent:
        garbled = self._line.unreadable > 0
        there = sorted(self.scan(range(1, _SCANNED + 1))) if not self._latest else []
        hint = (
            f"; ids that answer: {', '.join(map(str, there)) or 'none'}" if not self._latest else ""
        )
        why = " or what it says cannot be read" if garbled else ""
        return self._told(
            ServoSilent(
                f"{self._called(name, number)} does not answer{why}{hint}; look at its plug and the "
                "supply, or give it its id with `fpcad motors assign`"
            )
        )

    def _told(self, error: Fault) -> Fault:
        """The error with what the hand does now."""
        return error.leaving(_PULLING) if self._on else error
