"""Dynamixel X servos on Protocol 2.0: packets, registers, bus watchdog."""

from __future__ import annotations

import time

from tests.run.servos.bench import STALL_MA, ServoBench

HEADER = b"\xff\xff\xfd\x00"
STATUS = 0x55
ID, MODE, TORQUE, WATCHDOG, CURRENT_LIMIT, GOAL = 7, 11, 64, 98, 102, 116
TRIPPED = 0xFF


def crc16(data: bytes) -> int:
    """CRC-16 with polynomial 0x8005, most significant bit first."""
    value = 0
    for byte in data:
        value ^= byte << 8
        for _ in range(8):
            value = (value << 1 ^ (0x8005 if value & 0x8000 else 0)) & 0xFFFF
    return value


def status(number: int, error: int, data: bytes) -> bytes:
    body = bytes([STATUS, error]) + data
    body = body.replace(b"\xff\xff\xfd", b"\xff\xff\xfd\xfd")
    head = HEADER + bytes([number]) + (len(body) + 2).to_bytes(2, "little")
    return head + body + crc16(head + body).to_bytes(2, "little")


class DynamixelBench(ServoBench):
    width, number_register, goal_register = 2, ID, GOAL
    spoke_s = 0.0

    def boot(self, number: int) -> None:
        memory = self.memory[number]
        memory[0:2] = (1200).to_bytes(2, "little")
        memory[6], memory[ID], memory[MODE] = 52, number, 3
        memory[CURRENT_LIMIT : CURRENT_LIMIT + 2] = int(STALL_MA).to_bytes(2, "little")
        memory[GOAL : GOAL + 4] = (99).to_bytes(4, "little")  # a stale goal, far away

    def goal_counts(self, number: int) -> int:
        return int.from_bytes(self.memory[number][GOAL : GOAL + 4], "little", signed=True)

    def torque_on(self, number: int) -> bool:
        return bool(self.memory[number][TORQUE])

    def torque_share(self, number: int) -> float:
        return int.from_bytes(self.memory[number][102:104], "little") / STALL_MA

    def show(self, number: int, counts: int, current_ma: float) -> None:
        memory = self.memory[number]
        memory[126:128] = round(current_ma).to_bytes(2, "little", signed=True)
        memory[132:136] = counts.to_bytes(4, "little", signed=True)
        memory[146] = self.faults.temperature_c
        steps = memory[WATCHDOG]
        if 0 < steps < TRIPPED and time.monotonic() - self.spoke_s > 0.02 * steps:
            memory[WATCHDOG] = TRIPPED
            memory[GOAL : GOAL + 4] = memory[132:136]

    def answers(self, buffer: bytearray) -> bytes:
        out = b""
        while True:
            start = buffer.find(HEADER)
            if start < 0 or len(buffer) < start + 7:
                return out
            end = start + 7 + int.from_bytes(buffer[start + 5 : start + 7], "little")
            if len(buffer) < end:
                return out
            packet = bytes(buffer[start:end])
            del buffer[:end]
            if crc16(packet[:-2]) == int.from_bytes(packet[-2:], "little"):
                self.spoke_s = time.monotonic()
                body = packet[7:-2].replace(b"\xff\xff\xfd\xfd", b"\xff\xff\xfd")
                out += self.obey(packet[4], body[0], body[1:])

    def status(self, number: int, data: bytes) -> bytes:
        return status(number, self.faults.complaints.get(number, 0), data)

    def who(self, number: int) -> bytes:
        return bytes(self.memory[number][0:2]) + b"\x34"

    def refuses(self, number: int, address: int) -> bool:
        memory = self.memory[number]
        tripped = address == GOAL and memory[WATCHDOG] == TRIPPED
        locked = address in (ID, MODE) and bool(memory[TORQUE])
        return tripped or locked or super().refuses(number, address)
