"""The firmware's servo bus against servos that are simulated register by register."""

import ctypes

import numpy as np
import pytest

from fpcad.run.messages import MAX_JOINTS
from tests.firmware.core import library
from tests.firmware.half_duplex import Line, Mount, Readings, goals_at, line_to

STEP_RAD = 2 * np.pi / 4096


class Bus(ctypes.Structure):
    _fields_ = (
        ("line", ctypes.POINTER(Line)),
        ("count", ctypes.c_uint8),
        ("mounts", Mount * MAX_JOINTS),
        ("torque_on", ctypes.c_bool),
    )


def packet(ident, instruction, *parameters):
    body = bytes([ident, len(parameters) + 2, instruction, *parameters])
    return b"\xff\xff" + body + bytes([~sum(body) & 0xFF])


class Servos:
    """Servos with a table of registers each; goals are reached at once while torque is on."""

    def __init__(self, count=3):
        self.memory = {ident: bytearray(80) for ident in range(1, count + 1)}
        self.sent, self.answer = [], b""
        self.dead, self.flips, self.error = set(), 0, 0
        self._line = line_to(self._hear, self._say)
        self.bus = Bus(ctypes.pointer(self._line), count)
        for i, ident in enumerate(self.memory):
            self.bus.mounts[i] = Mount(ident, -1 if i == 1 else 1, 2048)
            self.memory[ident][56:58] = (2048).to_bytes(2, "little")
        self.readings = Readings()

    def _hear(self, said):
        self.sent.append(said)
        assert said == packet(said[2], said[4], *said[5:-1])
        if said[4] == 0x83:
            start, size = said[5], said[6]
            for at in range(7, len(said) - 1, size + 1):
                self._store(said[at], start, said[at + 1 : at + 1 + size])
        elif said[2] not in self.dead:
            memory = self.memory[said[2]][said[5] : said[5] + said[6]]
            self.answer = packet(said[2], self.error, *memory)

    def _store(self, ident, start, data):
        if ident in self.dead:
            return
        memory = self.memory[ident]
        memory[start : start + len(data)] = data
        if memory[40]:
            memory[56:58] = memory[42:44]

    def _say(self, room):
        said, self.answer = bytearray(self.answer[:room]), b""
        if said and self.flips:
            said[self.flips] ^= 4
        return bytes(said)

    def exchange(self, angles_rad, **changes):
        goals = goals_at(angles_rad, **changes)
        self.sent.clear()
        library().servo_bus_exchange(
            ctypes.byref(self.bus), ctypes.byref(goals), ctypes.byref(self.readings)
        )
        return self.readings


def test_packets_are_those_of_the_makers_manual():
    assert packet(1, 3, 0x2A, 0, 8, 0, 0, 0xE8, 3).hex() == "ffff0109032a00080000e803d5"
    servos = Servos()
    servos.exchange([0.0, 0.0, 0.0], torque_on=False)
    still = 0, 8, 0, 0, 0, 0, *(1000).to_bytes(2, "little")
    assert servos.sent[0] == packet(0xFE, 0x83, 42, 8, *(1, *still), *(2, *still), *(3, *still))
    assert servos.sent[1] == packet(1, 2, 56, 15)


def test_goals_are_reached_and_read_with_their_signs():
    servos = Servos()
    servos.exchange([0, 0, 0])
    angles = [0.5, 0.5, -1.0]
    servos.exchange(angles)
    assert servos.memory[1][42:44] != servos.memory[2][42:44]
    read = np.array(servos.exchange(angles).position[:3]) / 1e6
    np.testing.assert_allclose(read, angles, atol=STEP_RAD / 2 + 1e-6)


def test_torque_comes_on_only_where_the_goals_are():
    servos = Servos()
    servos.memory[2][56:58] = (1000).to_bytes(2, "little")
    servos.dead.add(3)
    servos.exchange([0, 0, 0])
    assert not servos.bus.torque_on and not servos.memory[1][40]
    servos.dead.clear()
    servos.exchange([0.1, 0, 0])
    assert servos.bus.torque_on and all(memory[40] for memory in servos.memory.values())
    order = [(said[4], said[5]) for said in servos.sent]
    assert order.index((0x83, 42)) < order.index((2, 42)) < order.index((0x83, 40))


def test_an_emergency_stop_takes_torque_from_all_at_once():
    servos = Servos()
    servos.exchange([0, 0, 0])
    servos.sent.clear()
    library().servo_bus_torque_off(ctypes.byref(servos.bus))
    assert servos.sent == [packet(0xFE, 0x83, 40, 1, 1, 0, 2, 0, 3, 0)] * 2
    assert not any(memory[40] for memory in servos.memory.values())


def test_a_dead_servo_keeps_its_last_reading_and_disturbs_no_other():
    servos = Servos()
    servos.exchange([0, 0, 0])
    servos.exchange([0.2, 0.2, 0.2])
    before = list(servos.exchange([0.2, 0.2, 0.2]).position)
    servos.dead.add(2)
    after = servos.exchange([0.3, 0.3, 0.3])
    assert list(after.answered[:3]) == [True, False, True]
    assert after.position[1] == before[1] and after.position[0] > before[0]


@pytest.mark.parametrize("place", range(1, 21))
def test_a_flipped_bit_anywhere_in_an_answer_is_no_answer(place):
    servos = Servos(1)
    servos.exchange([0])
    servos.flips = place
    assert not servos.exchange([0.5]).answered[0]


def test_a_servo_that_reports_an_error_counts_as_lost():
    servos = Servos(1)
    servos.error = 32  # overload
    assert not servos.exchange([0]).answered[0]


def test_current_and_temperature_are_read():
    servos = Servos(1)
    servos.memory[1][63] = 41
    servos.memory[1][69:71] = (0x8000 | 100).to_bytes(2, "little")
    read = servos.exchange([0])
    assert (read.temperature_c[0], read.current_ma[0]) == (41, -650)


def test_a_bound_on_the_current_is_a_share_of_the_torque():
    servos = Servos(1)
    servos.exchange([0], current_ma=270)
    assert int.from_bytes(servos.memory[1][48:50], "little") == 100
    servos.exchange([0])
    assert int.from_bytes(servos.memory[1][48:50], "little") == 1000
