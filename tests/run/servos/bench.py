"""Twelve simulated motors on one line, with the faults that real ones have."""

from __future__ import annotations

import os
import pty
import select
import threading
import time
import tty
from abc import ABC, abstractmethod
from dataclasses import dataclass, field

import numpy as np

from fpcad.run.motor_map import Mounting
from fpcad.run.sim.tendon_hand import TendonHand
from tests.run.virtual import Damage, untouched

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
    def goal_counts(self, number: int) -> int: ...

    @abstractmethod
    def torque_on(self, number: int) -> bool: ...

    @abstractmethod
    def torque_share(self, number: int) -> float: ...

    @abstractmethod
    def show(self, number: int, counts: int, current_ma: float) -> None:
        """Write what a servo measures to its memory."""

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
