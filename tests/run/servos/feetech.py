"""Feetech STS servos: packets with a sum, registers, no watchdog."""

from __future__ import annotations

from tests.run.servos.bench import ServoBench

ID, TORQUE, GOAL, TORQUE_LIMIT, LOCK, POSITION = 5, 40, 42, 48, 55, 56


def status(number: int, error: int, data: bytes) -> bytes:
    body = bytes([number, len(data) + 2, error]) + data
    return b"\xff\xff" + body + bytes([~sum(body) & 0xFF])


class FeetechBench(ServoBench):
    width, number_register, goal_register = 1, ID, GOAL

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

    def status(self, number: int, data: bytes) -> bytes:
        return status(number, self.faults.complaints.get(number, 0), data)

    def who(self, number: int) -> bytes:
        return b""

    def refuses(self, number: int, address: int) -> bool:
        locked = address == ID and bool(self.memory[number][LOCK])
        return locked or super().refuses(number, address)
