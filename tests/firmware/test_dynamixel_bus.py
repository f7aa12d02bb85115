"""The firmware's Dynamixel bus against servos that are simulated register by register."""

import ctypes

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fpcad.run.messages import MAX_JOINTS
from tests.firmware.core import library
from tests.firmware.half_duplex import Line, Mount, Readings, goals_at, line_to

STEP_RAD = 2 * np.pi / 4096
MODE, TORQUE, WATCHDOG, CURRENT, GOAL, STATE = 11, 64, 98, 102, 116, 126
READ, SYNC_READ, SYNC_WRITE, STATUS = 2, 0x82, 0x83, 0x55
HEADER = b"\xff\xff\xfd"


class Bus(ctypes.Structure):
    """`struct dynamixel_bus`."""

    _fields_ = (
        ("line", ctypes.POINTER(Line)),
        ("count", ctypes.c_uint8),
        ("mounts", Mount * MAX_JOINTS),
        ("full_ma", ctypes.c_int16),
        ("prepared", ctypes.c_bool),
        ("torque_on", ctypes.c_bool),
        ("bound_ma", ctypes.c_int16),
    )


def crc(data):
    value = 0
    for byte in data:
        value ^= byte << 8
        for _ in range(8):
            value = (value << 1 ^ 0x8005) & 0xFFFF if value & 0x8000 else value << 1
    return value.to_bytes(2, "little")


def packet(ident, instruction, parameters=b""):
    stuffed = parameters.replace(HEADER, HEADER + b"\xfd")
    body = HEADER + bytes([0, ident]) + (len(stuffed) + 3).to_bytes(2, "little")
    body += bytes([instruction]) + stuffed
    return body + crc(body)


def number(data):
    return int.from_bytes(data, "little", signed=True)


class Servos:
    """XL330s with a table of registers each; goals are reached at once while torque is on."""

    def __init__(self, count=3):
        self.memory = {ident: bytearray(150) for ident in range(1, count + 1)}
        self.sent, self.answers = [], b""
        self.dead, self.flip, self.error = set(), None, 0
        self._line = line_to(self._hear, self._say)
        self.bus = Bus(ctypes.pointer(self._line), count, full_ma=1500)
        for i, ident in enumerate(self.memory):
            self.bus.mounts[i] = Mount(ident, -1 if i == 1 else 1, 2048)
            self.memory[ident][MODE] = 3
            self._place(ident, 2048)
        self.readings = Readings()

    def _place(self, ident, steps):
        self.memory[ident][132:136] = steps.to_bytes(4, "little", signed=True)

    def _hear(self, said):
        assert said[:3] == HEADER and said[-2:] == crc(said[:-2])
        assert int.from_bytes(said[5:7], "little") == len(said) - 7
        ident, instruction = said[4], said[7]
        parameters = said[8:-2].replace(HEADER + b"\xfd", HEADER)
        self.sent.append((ident, instruction, parameters))
        start, size = (int.from_bytes(parameters[k : k + 2], "little") for k in (0, 2))
        if instruction == SYNC_WRITE:
            for at in range(4, len(parameters), size + 1):
                self._store(parameters[at], start, parameters[at + 1 : at + 1 + size])
        elif instruction == SYNC_READ:
            self.answers = b"".join(self._answer(each, start, size) for each in parameters[4:])
        else:
            self.answers = self._answer(ident, start, size)

    def _answer(self, ident, start, size):
        if ident in self.dead:
            return b""
        return packet(ident, STATUS, bytes([self.error]) + self.memory[ident][start : start + size])

    def _store(self, ident, start, data):
        if ident in self.dead or (start == MODE and self.memory[ident][TORQUE]):
            return
        memory = self.memory[ident]
        memory[start : start + len(data)] = data
        if memory[TORQUE]:
            memory[132:136] = memory[GOAL : GOAL + 4]

    def _say(self, room):
        said, self.answers = bytearray(self.answers[:room]), self.answers[room:]
        if said and self.flip is not None:
            said[self.flip % len(said)] ^= 4
        return bytes(said)

    def exchange(self, angles_rad, **changes):
        goals = goals_at(angles_rad, **changes)
        self.sent.clear()
        library().dynamixel_bus_exchange(
            ctypes.byref(self.bus), ctypes.byref(goals), ctypes.byref(self.readings)
        )
        return self.readings


def framed(ident, instruction, parameters):
    room = ctypes.create_string_buffer(bytes(8) + parameters, 255)
    length = library().dynamixel_frame(room, ident, instruction, ctypes.c_uint8(len(parameters)))
    return room.raw[: length & 0xFF]


@pytest.mark.parametrize(
    ("ident", "instruction", "parameters", "wire"),
    [
        (1, 1, "", "fffffd00010300 01194e"),
        (1, 2, "84000400", "fffffd00010700 02 84000400 1d15"),
        (1, 3, "7400 00020000", "fffffd00010900 03 7400 00020000 ca89"),
    ],
)
def test_packets_are_those_of_the_makers_manual(ident, instruction, parameters, wire):
    assert framed(ident, instruction, bytes.fromhex(parameters)) == bytes.fromhex(wire)


@given(st.lists(st.sampled_from([0xFF, 0xFD, 0x00]), max_size=60).map(bytes))
def test_what_looks_like_a_header_is_stuffed_as_by_the_maker(parameters):
    assert framed(7, SYNC_WRITE, parameters) == packet(7, SYNC_WRITE, parameters)


def test_mode_and_watchdog_are_set_before_torque():
    servos = Servos()
    servos.exchange([0, 0, 0])
    written = [(p[0], p[5]) for _, what, p in servos.sent if what == SYNC_WRITE]
    order = [register for register, _ in written]
    assert order.index(TORQUE) < order.index(MODE) < order.index(GOAL)
    assert (WATCHDOG, 0) in written and (WATCHDOG, 5) in written
    assert order[-1] == TORQUE and written[-1][1] == 1
    assert all(memory[MODE] == 5 and memory[TORQUE] for memory in servos.memory.values())


def test_goals_are_reached_and_read_with_their_signs():
    servos = Servos()
    servos.exchange([0, 0, 0])
    angles = [0.5, 0.5, -4.0]  # beyond a turn's half, which this mode can
    servos.exchange(angles)
    assert number(servos.memory[3][GOAL : GOAL + 4]) < 0
    read = np.array(servos.exchange(angles).position[:3]) / 1e6
    np.testing.assert_allclose(read, angles, atol=STEP_RAD / 2 + 1e-6)


def test_all_states_come_back_after_one_question():
    servos = Servos(12)
    servos.exchange([0] * 12)
    servos.exchange([0.1] * 12)
    assert [what for _, what, _ in servos.sent] == [SYNC_WRITE, SYNC_READ]
    assert all(servos.readings.answered[:12])


def test_a_bound_on_the_current_is_written_when_it_changes():
    servos = Servos(1)
    servos.exchange([0], current_ma=300)
    assert number(servos.memory[1][CURRENT : CURRENT + 2]) == 300
    servos.exchange([0], current_ma=300)
    assert [p[0] for _, what, p in servos.sent if what == SYNC_WRITE] == [GOAL]
    servos.exchange([0])
    assert number(servos.memory[1][CURRENT : CURRENT + 2]) == 1500


def test_no_torque_while_a_servo_is_missing_or_in_another_mode():
    servos = Servos()
    servos.dead.add(2)
    servos.exchange([0, 0, 0])
    assert not servos.bus.torque_on and not servos.memory[1][TORQUE]
    servos.dead.clear()
    servos.exchange([0, 0, 0])
    assert servos.bus.torque_on and all(memory[TORQUE] for memory in servos.memory.values())


def test_an_emergency_stop_takes_torque_from_all_at_once():
    servos = Servos()
    servos.exchange([0, 0, 0])
    servos.sent.clear()
    library().dynamixel_bus_torque_off(ctypes.byref(servos.bus))
    off = (0xFE, SYNC_WRITE, bytes([TORQUE, 0, 1, 0, 1, 0, 2, 0, 3, 0]))
    assert servos.sent == [off, off]
    assert not any(memory[TORQUE] for memory in servos.memory.values())


@pytest.mark.parametrize("dead", [1, 2, 3])
def test_a_dead_servo_keeps_its_last_reading_and_disturbs_no_other(dead):
    servos = Servos()
    servos.exchange([0, 0, 0])
    before = list(servos.exchange([0.2, 0.2, 0.2]).position)
    servos.dead.add(dead)
    after = servos.exchange([0.3, 0.3, 0.3])
    assert list(after.answered[:3]) == [ident != dead for ident in (1, 2, 3)]
    moved = [now != then for now, then in zip(after.position[:3], before[:3], strict=True)]
    assert moved == list(after.answered[:3])


@pytest.mark.parametrize("place", range(32))
def test_a_flipped_bit_anywhere_in_an_answer_is_no_answer(place):
    servos = Servos(1)
    servos.exchange([0])
    servos.flip = place
    assert not servos.exchange([0.5]).answered[0]


def test_a_stuffed_answer_is_read():
    servos = Servos(1)
    servos.exchange([0])
    servos.memory[1][TORQUE] = 0
    servos.memory[1][STATE : STATE + 4] = b"\xff\xff\xfd\xff"
    read = servos.exchange([0], torque_on=True)
    assert read.answered[0] and read.current_ma[0] == -1


def test_a_servo_that_reports_an_error_counts_as_lost():
    servos = Servos(1)
    servos.exchange([0])
    servos.error = 0x80  # hardware alert
    assert not servos.exchange([0]).answered[0]


def test_current_and_temperature_are_read():
    servos = Servos(1)
    servos.exchange([0])
    servos.memory[1][146] = 41
    servos.memory[1][126:128] = (-650).to_bytes(2, "little", signed=True)
    read = servos.exchange([0])
    assert (read.temperature_c[0], read.current_ma[0]) == (41, -650)
