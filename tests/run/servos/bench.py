"""Twelve simulated motors on one line, with the faults that real ones have."""

from __future__ import annotations

import itertools
import os
import pty
import select
import threading
import time
import tty
from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from fpcad.run.motor_map import Mounting
from fpcad.run.sim.tendon_hand import TendonHand
from tests.run.virtual import Damage, untouched

PING, READ, WRITE, SYNC_READ, SYNC_WRITE = 0x01, 0x02, 0x03, 0x82, 0x83
"""Instructions, the same for both makers."""
COUNT_RAD = 2 * np.pi / 4096
STALL_MA = 2700.0


@dataclass
class Faults:
    """What is wrong with the bench; tests change it while it runs."""

    dead: set[int] = field(default_factory=set)
    to_servos: Damage = untouched
    to_host: Damage = untouched
    deaf_goals: set[int] = field(default_factory=set)
    """Servos that keep the goal that they have."""
    complaints: dict[int, int] = field(default_factory=dict)
    """Error bytes that servos send with each answer."""
    temperature_c: int = 25


class ServoBench(ABC):
    """Memory of each servo by id, and the hand that their motors pull."""

    width: ClassVar[int]
    """Bytes of a register's address, and of a length."""
    number_register: ClassVar[int]
    goal_register: ClassVar[int]

    def __init__(self, hand: TendonHand, mounting: Mounting, numbers: tuple[int, ...]) -> None:
        self.hand, self.mounting = hand, mounting
        self.faults = Faults()
        self.pace = 1.0
        self.memory = {n: bytearray(256) for n in numbers}
        self._place = {n: i for i, n in enumerate(numbers)}
        self._at_s = time.monotonic()
        self._buffer = bytearray()
        self._stop = threading.Event()
        for n in numbers:
            self.boot(n)
        self._master, self._slave = pty.openpty()
        tty.setraw(self._slave)
        self.port = os.ttyname(self._slave)
        self._thread = threading.Thread(target=self._serve, daemon=True)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.unplug()

    def unplug(self) -> None:
        """The adapter is pulled out: its port is gone."""
        if not self._stop.is_set():
            self._stop.set()
            self._thread.join()
            os.close(self._slave)
            os.close(self._master)

    @abstractmethod
    def boot(self, number: int) -> None:
        """Fill a servo's memory as it is when power comes."""

    @abstractmethod
    def answers(self, buffer: bytearray) -> bytes:
        """Take whole instructions out of the buffer, obey them, and answer."""

    @abstractmethod
    def status(self, number: int, data: bytes) -> bytes:
        """A servo's answer as a packet."""

    @abstractmethod
    def who(self, number: int) -> bytes:
        """What a servo answers to a ping."""

    def refuses(self, number: int, address: int) -> bool:
        """Whether a register cannot be written now."""
        return address == self.goal_register and number in self.faults.deaf_goals

    @abstractmethod
    def goal_counts(self, number: int) -> int: ...

    @abstractmethod
    def torque_on(self, number: int) -> bool: ...

    @abstractmethod
    def torque_share(self, number: int) -> float: ...

    @abstractmethod
    def show(self, number: int, counts: int, current_ma: float) -> None:
        """Write what a servo measures to its memory."""

    def obey(self, number: int, instruction: int, data: bytes) -> bytes:
        """Carry out one instruction; what the servos answer."""
        width = self.width
        address = int.from_bytes(data[:width], "little")
        length = int.from_bytes(data[width : 2 * width], "little")
        rest = data[2 * width :]
        if instruction == SYNC_READ:
            return self.answer_in_turn(rest, address, length)
        if instruction == SYNC_WRITE:
            for i in range(0, len(rest), 1 + length):
                self.write(rest[i], address, rest[i + 1 : i + 1 + length])
            return b""
        if not self.listens(number):
            return b""
        if instruction == PING:
            return self.status(number, self.who(number))
        if instruction == READ:
            return self.status(number, bytes(self.memory[number][address : address + length]))
        self.write(number, address, data[width:])
        return self.status(number, b"")

    def answer_in_turn(self, numbers: bytes, address: int, length: int) -> bytes:
        """Each waits for the one before it, so nobody follows one that is silent."""
        there = itertools.takewhile(self.listens, numbers)
        return b"".join(
            self.status(n, bytes(self.memory[n][address : address + length])) for n in there
        )

    def write(self, number: int, address: int, data: bytes) -> None:
        if not self.listens(number) or self.refuses(number, address):
            return
        self.memory[number][address : address + len(data)] = data
        if address == self.number_register:
            self.renumber(number, data[0])

    def listens(self, number: int) -> bool:
        return number in self.memory and number not in self.faults.dead

    def renumber(self, old: int, new: int) -> None:
        self.memory[new] = self.memory.pop(old)
        self._place[new] = self._place.pop(old)

    def counts(self) -> np.ndarray:
        """What the encoders say (n,)."""
        return np.rint(self.mounting.to_bus(self.hand.spool_rad) / COUNT_RAD).astype(int) + 2048

    def pass_time(self) -> None:
        now = time.monotonic()
        seconds, self._at_s = self.pace * (now - self._at_s), now
        numbers = sorted(self._place, key=lambda n: self._place[n])
        goal = np.array([self.goal_counts(n) - 2048 for n in numbers]) * COUNT_RAD
        on = np.array([self.torque_on(n) and n not in self.faults.dead for n in numbers])
        share = np.array([self.torque_share(n) for n in numbers])
        if seconds > 0:
            self.hand.step(self.mounting.to_spool(goal), on, share, seconds)
        counts, torque = self.counts(), np.abs(self.hand.torque_nm)
        for n, i in self._place.items():
            self.show(n, int(counts[i]), float(torque[i]) / 2.94 * STALL_MA)

    def _serve(self) -> None:
        while not self._stop.is_set():
            ready, _, _ = select.select([self._master], [], [], 0.02)
            if not ready:
                self.pass_time()
                continue
            self._buffer += self.faults.to_servos(os.read(self._master, 4096))
            self.pass_time()
            answer = self.answers(self._buffer)
            if answer:
                os.write(self._master, self.faults.to_host(answer))
