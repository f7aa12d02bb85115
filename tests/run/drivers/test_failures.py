"""What goes wrong on servo buses: one line that says what happened, how the hand is, what to do."""

import errno
import sys

import numpy as np
import pytest
import serial

from fpcad.errors import ToolchainError
from fpcad.run.errors import (
    PortBusy,
    PortForbidden,
    PortMissing,
    ServoFault,
    ServoMismatch,
    ServoSilent,
)
from tests.run.drivers.rigs import NUMBERS, SERVOS, servo_bench, servo_bus

SDKS = {"dynamixel": "dynamixel_sdk", "feetech": "scservo_sdk"}


@pytest.fixture(params=SERVOS)
def maker(request):
    return request.param


@pytest.fixture
def bench(maker):
    with servo_bench(maker) as there:
        yield there


def failure(cause, kind, *words, hand="The hand did not move."):
    """The one line that an action fails with."""
    with pytest.raises(kind) as caught:
        cause()
    said = str(caught.value)
    assert "\n" not in said and said.endswith(hand)
    assert all(word in said for word in words), said
    return said


def test_a_dead_servo_is_named_before_anything_moves(maker, bench):
    bench.faults.dead.add(3)
    bus = servo_bus(maker, bench.port)
    failure(bus.open, ServoSilent, "thumb_m3 (id 3 on", "does not answer", "look at its plug")


def test_a_wrong_id_comes_with_those_that_answer(maker, bench):
    numbers = (*NUMBERS[:11], 40)
    bus = servo_bus(maker, bench.port, numbers)
    failure(bus.open, ServoSilent, "ring_m3 (id 40", "ids that answer: 1, 2, 3", "motors assign")


def test_another_servo_than_the_design_has_is_told(bench, maker):
    bench.memory[5][0:5] = bytes([6, 4, 0, 1, 4])  # XL430 to one maker, an unknown one to the other
    bus = servo_bus(maker, bench.port)
    failure(bus.open, ServoMismatch, "index_m2", "the design wants", "correct `motors:`")


def test_a_goal_that_a_servo_does_not_take_keeps_torque_off(bench, maker):
    bus = servo_bus(maker, bench.port)
    bus.open()
    bench.faults.deaf_goals.add(7)
    failure(lambda: bus.torque(True), ServoFault, "middle_m1", "torque stays off")
    assert not any(bench.torque_on(n) for n in NUMBERS)
    bus.close()


def test_a_servo_that_complains_is_named(bench, maker):
    bus = servo_bus(maker, bench.port)
    bus.open()
    bus.torque(True)
    bench.faults.complaints[9] = 0x80 if maker == "dynamixel" else 0x20
    bench.memory[9][70] = 0x20  # where Dynamixels keep what hurts
    hand = "Its other servos hold their last goals."
    failure(bus.read_state, ServoFault, "middle_m3", "overload", "cool", hand=hand)
    bus.close()


def test_a_port_that_another_program_holds(bench, maker):
    with serial.Serial(bench.port, exclusive=True):
        failure(servo_bus(maker, bench.port).open, PortBusy, "another program holds the port")


def test_a_port_that_is_not_there(maker):
    failure(servo_bus(maker, "/dev/ttyNOWHERE").open, PortMissing, "no such port")


def test_a_port_without_permission(maker, monkeypatch):
    def refuse(*_args, **_kwargs):
        raise serial.SerialException(errno.EACCES, "could not open port")

    monkeypatch.setattr(serial, "Serial", refuse)
    failure(servo_bus(maker, "/dev/ttyUSB0").open, PortForbidden, "usermod -aG dialout")


def test_an_sdk_that_is_not_installed_says_how(maker, monkeypatch):
    monkeypatch.setitem(sys.modules, SDKS[maker], None)
    failure(servo_bus(maker, "/dev/ttyUSB0").open, ToolchainError, "pip install", hand="]'")


def test_a_reply_that_trips_the_sdk_s_parser_is_only_unreadable(maker, bench):
    bus = servo_bus(maker, bench.port)
    bus.open()
    bus.read_state()
    noise = iter(
        [bytes([0xFF, 0xFF, 0xFD, 0, 1, 4, 0, 0x55, 0]) + bytes(40), b"\xff\xff\x01\x00" * 9]
    )
    bench.faults.to_host = lambda data: next(noise, data)
    for _ in range(4):
        state = bus.read_state()
    assert np.isfinite(state.position_rad).all()
    bus.close()


def test_a_servo_gets_a_new_id(maker, bench):
    bus = servo_bus(maker, bench.port)
    bus.connect_only()
    bus.assign(12, 40)
    assert 40 in bench.memory and 12 not in bench.memory
    with pytest.raises(ServoMismatch, match="id 2 is taken"):
        bus.assign(1, 2)
    with pytest.raises(ServoSilent, match=r"id 12 .*does not answer"):
        bus.assign(12, 13)
    assert bus.scan(range(39, 42)) == {40: bus._wanted.name}
    bus.close()
