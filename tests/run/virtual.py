"""A controller and a line in one thread with a clock of their own: faults at will, no waiting."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from fpcad.run.port import READ_WAIT_S
from fpcad.run.sim.controller import TICK_HZ, Controller, ControllerSetup
from fpcad.run.sim.plant import Plant
from tests.run.fixtures import hand_limits, swing

Damage = Callable[[bytes], bytes]


def untouched(data: bytes) -> bytes:
    return data


def simulated_controller(**changes) -> Controller:
    start = changes.pop("start_rad", swing().position[0])
    setup = {"limits": hand_limits(), "boot_nonce": 7, **changes}
    return Controller(ControllerSetup(**setup), Plant(start))


maker: Callable[..., Any] = simulated_controller
"""Who makes controllers: `each_controller` of conftest.py lets tests run on the firmware too."""


def controller(**changes) -> Any:
    return maker(**changes)


@dataclass
class VirtualLine:
    """Transport and clock: reading lets time pass, and with it the controller."""

    device: Any = field(default_factory=controller)
    to_device: Damage = untouched
    to_host: Damage = untouched
    baud_rate: int | None = None
    connected: bool = True
    now_s: float = 0.0
    on_tick: Callable[[VirtualLine], None] | None = None
    log: list[bytes] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._to_device, self._backlog, self._to_host = bytearray(), bytearray(), bytearray()

    def clock(self) -> float:
        return self.now_s

    def write(self, data: bytes) -> None:
        self.log.append(data)
        if self.connected:
            self._to_device += self.to_device(data)
            self._deliver(None if self.baud_rate is None else 0)

    def read(self) -> bytes:
        data = self._collect()
        if not data:
            self.let_pass(READ_WAIT_S)
            data = self._collect()
        return data

    def let_pass(self, seconds: float) -> None:
        """Time passes; at a baud rate, each tick carries its share of bytes each way."""
        share = None if self.baud_rate is None else self.baud_rate // 10 // TICK_HZ
        for _ in range(max(round(seconds * TICK_HZ), 1)):
            self.now_s += 1 / TICK_HZ
            self._deliver(share)
            self.device.tick()
            if self.on_tick is not None:
                self.on_tick(self)

    def close(self) -> None:
        self.connected = False

    def _deliver(self, limit: int | None) -> None:
        """Carry up to `limit` bytes each way."""
        self.device.receive(bytes(self._to_device[:limit]))
        del self._to_device[:limit]
        output = self.device.take_output()
        if self.connected and output:
            self._backlog += self.to_host(output)
        self._to_host += self._backlog[:limit]
        del self._backlog[:limit]

    def _collect(self) -> bytes:
        if self.baud_rate is None:
            self._deliver(None)
        data = bytes(self._to_host)
        self._to_host.clear()
        return data


def bit_flips(rate: float, seed: int) -> Damage:
    """Flips one bit in each byte with probability `rate`."""
    chance = random.Random(seed)

    def damage(data: bytes) -> bytes:
        return bytes(
            byte ^ (1 << chance.randrange(8)) if chance.random() < rate else byte for byte in data
        )

    return damage


def lost_bytes(rate: float, seed: int) -> Damage:
    chance = random.Random(seed)
    return lambda data: bytes(byte for byte in data if chance.random() >= rate)


def lost_frames(rate: float, seed: int) -> Damage:
    """Loses, doubles or delays whole frames, each with probability `rate`."""
    chance = random.Random(seed)
    late: list[bytes] = []

    def damage(data: bytes) -> bytes:
        out = b""
        for frame in data.split(b"\0")[:-1]:
            piece = frame + b"\0"
            fate = chance.random() / rate if rate else 9.0
            if fate < 1:
                continue
            if fate < 2:
                piece *= 2
            elif fate < 3:
                late.append(piece)
                continue
            out += piece
            while late:
                out += late.pop()
        return out

    return damage
