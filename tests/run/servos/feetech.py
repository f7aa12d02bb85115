"""Feetech STS servos: packets with a sum, registers, no watchdog."""

from __future__ import annotations

from tests.run.servos.bench import ServoBench

PING, READ, WRITE, SYNC_READ, SYNC_WRITE = 0x01, 0x02, 0x03, 0x82, 0x83
ID, TORQUE, GOAL, TORQUE_LIMIT, LOCK, POSITION = 5, 40, 42, 48, 55, 56


def status(number: int, error: int, data: bytes) -> bytes:
    body = bytes([number, len(data) + 2, error]) + data
    return b"\xff\xff" + body + bytes([~sum(body) & 0xFF])


class FeetechBench(ServoBench):
    def boot(self, number: int) -> None:
        memory = self.memory[number]
        memory[0:5] = bytes([3, 10, 0, 9, 3])  # firmware 3.10, model 777
        memory[ID], memory[LOCK] = number, 1
        memory[TORQUE_LIMIT : TORQUE_LIMIT + 2] = (1000).to_bytes(2, "little")
        memory[GOAL : GOAL + 2] = (99).to_bytes(2, "little")  # a stale goal, far away

    def goal_counts(self, number: int) -> int:
        return int.from_bytes(self.memory[number][GOAL : GOAL + 2], "little")

    def torque_on(self, number: int) -> bool:
        return bool(self.memory[number][TORQUE])

    def torque_share(self, number: int) -> float:
        return int.from_bytes(self.memory[number][TORQUE_LIMIT : TORQUE_LIMIT + 2], "little") / 1000

    def show(self, number: int, counts: int, current_ma: float) -> None:
        memory = self.memory[number]
        memory[POSITION : POSITION + 2] = (counts & 0x0FFF).to_bytes(2, "little")
        memory[63] = self.faults.temperature_c
        memory[69:71] = round(current_ma / 6.5).to_bytes(2, "little")

    def answers(self, buffer: bytearray) -> bytes:
        out = b""
        while True:
            start = buffer.find(b"\xff\xff")
            if start < 0 or len(buffer) < start + 4:
                return out
            end = start + 4 + buffer[start + 3]
            if len(buffer) < end:
                return out
            packet = bytes(buffer[start:end])
            if len(packet) < 6 or ~sum(packet[2:-1]) & 0xFF != packet[-1]:
                del buffer[: start + 1]
                continue
            del buffer[:end]
            out += self.obey(packet[2], packet[4], packet[5:-1])

    def obey(self, number: int, instruction: int, data: bytes) -> bytes:
        if instruction == SYNC_READ:
            return self.answer_in_turn(data[2:], data[0], data[1])
        if instruction == SYNC_WRITE:
            address, length = data[0], data[1]
            for i in range(2, len(data), 1 + length):
                self.write(data[i], address, data[i + 1 : i + 1 + length])
            return b""
        if number not in self.memory or number in self.faults.dead:
            return b""
        error = self.faults.complaints.get(number, 0)
        if instruction == PING:
            return status(number, error, b"")
        if instruction == READ:
            return status(number, error, bytes(self.memory[number][data[0] : data[0] + data[1]]))
        self.write(number, data[0], data[1:])
        return status(number, error, b"")

    def answer_in_turn(self, numbers: bytes, address: int, length: int) -> bytes:
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
        if address == GOAL and number in self.faults.deaf_goals:
            return
        if address == ID and memory[LOCK]:
            return
        memory[address : address + len(data)] = data
        if address == ID:
            self.renumber(number, data[0])
