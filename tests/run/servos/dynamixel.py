"""Dynamixel X servos on Protocol 2.0: packets, registers, bus watchdog."""

from __future__ import annotations

import time

from tests.run.servos.bench import STALL_MA, ServoBench

HEADER = b"\xff\xff\xfd\x00"
PING, READ, WRITE, STATUS, SYNC_READ, SYNC_WRITE = 0x01, 0x02, 0x03, 0x55, 0x82, 0x83
EVERYBODY = 0xFE
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

    def obey(self, number: int, instruction: int, data: bytes) -> bytes:
        address, length = int.from_bytes(data[:2], "little"), int.from_bytes(data[2:4], "little")
        if instruction == SYNC_READ:
            return self.answer_in_turn(data[4:], address, length)
        if instruction == SYNC_WRITE:
            for i in range(4, len(data), 1 + length):
                self.write(data[i], address, data[i + 1 : i + 1 + length])
            return b""
        if number not in self.memory or number in self.faults.dead:
            return b""
        error = self.faults.complaints.get(number, 0)
        if instruction == PING:
            return status(number, error, bytes(self.memory[number][0:2]) + b"\x34")
        if instruction == READ:
            return status(number, error, bytes(self.memory[number][address : address + length]))
        self.write(number, address, data[2:])
        return status(number, error, b"")

    def answer_in_turn(self, numbers: bytes, address: int, length: int) -> bytes:
        """Each waits for the one before it, so nobody follows one that is silent."""
        out = b""
        for n in numbers:
            if n in self.faults.dead or n not in self.memory:
                break
            error = self.faults.complaints.get(n, 0)
            out += status(n, error, bytes(self.memory[n][address : address + length]))
        return out

    def write(self, number: int, address: int, data: bytes) -> None:
        memory = self.memory.get(number)
        if memory is None or number in self.faults.dead:
            return
        if address == GOAL and (memory[WATCHDOG] == TRIPPED or number in self.faults.deaf_goals):
            return
        if address in (ID, MODE) and memory[TORQUE]:
            return
        memory[address : address + len(data)] = data
        if address == ID:
            self.renumber(number, data[0])
