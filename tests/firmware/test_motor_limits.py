"""A box of joints is no box of motors: what two joints may do, their motors together may not."""

import ctypes
from dataclasses import replace

import numpy as np
import pytest

from fpcad.run.acceptance import first_violation
from fpcad.run.firmware_setup import GAIN
from fpcad.run.knots import from_wire
from fpcad.run.messages import Ack, Arm, Knot, Reason, Refused
from fpcad.run.motor_limits import MotorLimits, first_motor_violation, motor_limits_of
from fpcad.run.transmission import Transmission, read_transmission
from tests.firmware.core import library
from tests.firmware.test_core import plausible_segments
from tests.firmware.test_transmission import YAML
from tests.run.fixtures import NAMES, hand_limits
from tests.run.test_states import Bench, knot

LIMITS = hand_limits(
    configuration=YAML,
    velocity_rad_s=np.full(12, 4.0),
    acceleration_rad_s2=np.full(12, 80.0),
)
GEARS = read_transmission(YAML, NAMES)
SERVO_SPEED = 4.71


def turning(flexion=0.0, abduction=0.0):
    """Knots that end with these speeds of the index finger's flexion and abduction [rad/s]."""
    here = knot(0).position_urad
    velocity = np.zeros(12)
    velocity[3:5] = flexion, abduction
    start = [knot(0), knot(300_000)]
    counts = tuple(np.rint(velocity * 1e6).astype(int).tolist())
    return [*start, replace(knot(400_000, here), velocity_urad_s=counts)]


@pytest.mark.parametrize(
    ("flexion", "abduction", "motor"),
    [(2.5, 2.5, 3), (2.5, -2.5, 4), (-2.5, 2.5, 4), (-2.5, -2.5, 3)],
)
@pytest.mark.usefixtures("each_controller")
def test_two_legal_joints_can_be_too_fast_for_their_motor(flexion, abduction, motor):
    limits = hand_limits(
        configuration=YAML,
        velocity_rad_s=np.full(12, 4.0),
        acceleration_rad_s2=np.full(12, 1000.0),
    )
    knots = turning(flexion, abduction)
    assert first_violation(from_wire(tuple(knots)), limits) is None
    found = first_motor_violation(from_wire(tuple(knots)), GEARS, motor_limits_of(limits))
    assert found is not None and found.joint == motor
    assert found.reason in (Reason.MOTOR_VELOCITY_LIMIT, Reason.MOTOR_ACCELERATION_LIMIT)
    bench = Bench(limits=limits)
    for message in (Arm(), *knots[:-1]):
        assert isinstance(bench.ask(message), Ack)
    answer = bench.ask(knots[-1])
    assert isinstance(answer, Refused)
    assert (answer.reason, answer.joint) == (found.reason, motor)


def test_limits_of_motors_follow_from_their_type():
    named = hand_limits(configuration=YAML + b"motor_type: XL330-M288\n")
    assert motor_limits_of(named).velocity_rad_s[0] == 10.79
    assert motor_limits_of(LIMITS).velocity_rad_s[0] == SERVO_SPEED


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("gain", [0.5, -1.0, 2.0])
def test_segments_of_motors_are_judged_alike_in_c_and_python(gain, seed):
    rows = plausible_segments(1_000, seed)
    zero, size = 0.25, abs(gain)
    box = np.array([zero - 1.5 * size, zero + 1.5 * size, 1.3 * size, 9.0 * size])
    numbers = np.array(
        [-(2**31), *[2**31 - 1] * 3, *np.rint(box * 1e6), gain * GAIN, zero * 1e6], np.int64
    ).astype(np.int32)
    reasons = np.zeros(len(rows), np.uint8)
    pointers = (array.ctypes.data_as(ctypes.c_void_p) for array in (rows, numbers, reasons))
    library().bench_violation(*pointers, len(rows))
    ours = [judged(row, gain, zero, box) for row in rows]
    assert len(set(ours)) == 4 and 0.05 < np.mean(np.array(ours) == 0) < 0.95
    np.testing.assert_array_equal(reasons, ours)


def judged(row, gain, zero, box):
    one = MotorLimits(*(np.array([x]) for x in box))
    wire = [knot_of(row[:4]), knot_of(row[4:8])]
    found = first_motor_violation(
        from_wire(tuple(wire)), Transmission(np.array([[gain]]), np.array([zero])), one
    )
    return 0 if found is None else int(found.reason)


def knot_of(row):
    t, p, v, a = (int(x) for x in row)
    return Knot(t, (p,), (v,), (a,), (0,))
