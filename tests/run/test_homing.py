"""Homing on simulated motors and tendons: what it finds, and how it must fail."""

import time
from dataclasses import replace

import numpy as np
import pytest

from fpcad.run.drivers.sim import SimBus
from fpcad.run.errors import HeldByUser, HomingError
from fpcad.run.homing import Homing
from fpcad.run.motor_map import MotorMap, Mounting
from fpcad.run.sim.tendon_hand import TendonHand
from fpcad.run.transmission import Transmission
from tests.run.drivers.rigs import GEARS, MOTORS, SERVOS, motor_map, mounting, tendon_hand
from tests.run.drivers.test_servo_driver import Time
from tests.run.fixtures import NAMES, hand_limits

COLUMNS = ("lower_rad", "upper_rad", "velocity_rad_s", "acceleration_rad_s2")


def homing(mounted=None, assumed=None, hand=None, limits=None, **changes):
    """A search on a hand whose motors sit as `mounted`, begun with the signs of `assumed`."""
    clock = Time()
    bus = SimBus(MOTORS, hand or tendon_hand(), mounted or mounting(), clock.clock)
    bus.open()
    known = motor_map(assumed or mounting(0.0))
    return bus, Homing(bus, known, limits or hand_limits(), clock.clock, clock.sleep, **changes)


def test_zeros_are_found_within_a_degree_wherever_motors_sit():
    for zero in (-0.7, 2.0):
        bus, search = homing(mounting(zero))
        found = search.run()
        assert np.abs(found.motors.mounting.zero_rad - bus.mounting.zero_rad).max() < np.radians(1)
        error = found.motors.to_joints(bus.read_state().position_rad) - bus.hand.joint_rad
        assert np.abs(error).max() < np.radians(1)


def test_ends_are_those_of_the_joints_but_for_the_stretch_of_tendons():
    _, search = homing()
    found = search.run()
    assert np.abs(found.lower_rad - hand_limits().lower_rad).max() < np.radians(4)
    assert np.abs(found.upper_rad - hand_limits().upper_rad).max() < np.radians(4)


def test_reversed_and_geared_motors_are_homed_when_they_are_known():
    sign = np.tile([1.0, -1.0, 1.0], 4)
    there = mounting(sign=sign, ratio=np.full(12, 2.0))
    bus, search = homing(there, mounting(0.0, sign=sign, ratio=np.full(12, 2.0)))
    error = search.run().motors.mounting.zero_rad - bus.mounting.zero_rad
    assert np.abs(error).max() < np.radians(2)


@pytest.mark.parametrize("motor", [0, 1, 4])
def test_a_motor_that_turns_the_other_way_is_found_by_the_ranges(motor):
    sign = np.ones(12)
    sign[motor] = -1
    _, search = homing(mounting(sign=sign))
    finger = "thumb" if motor < 3 else "index"
    with pytest.raises(HomingError, match=rf"{finger}_mcp_.*(look at sign|no end)"):
        search.run()


def test_a_joint_that_turns_less_than_designed_is_told():
    limits = hand_limits()
    upper = limits.upper_rad.copy()
    upper[2] -= 0.4
    bus, search = homing(hand=tendon_hand(limits=hand_limits(upper_rad=upper)))
    with pytest.raises(HomingError, match=r"thumb_ip_flex: turns \d+ degrees .*holds where it is"):
        search.run()
    assert bus.read_state().torque_on


def test_a_joint_without_end_is_told():
    upper = hand_limits().upper_rad + 20.0
    _, search = homing(hand=tendon_hand(limits=hand_limits(upper_rad=upper)))
    with pytest.raises(HomingError, match="thumb_mcp_flex: no end"):
        search.run()


def test_an_encoder_that_ends_on_the_way_is_told():
    bus, search = homing(mounting(2.0))
    bus.goal_range_rad = (-np.pi, np.pi)
    with pytest.raises(HomingError, match=r"_m\d: its range crosses the end of its encoder"):
        search.run()


def test_ctrl_c_holds_and_twice_lets_go():
    for wanted in (1, 2):
        seen = []
        bus, search = homing(on_report=seen.append, stops=lambda n=wanted, s=seen: n * (len(s) > 4))
        with pytest.raises(HeldByUser, match="zeros are unknown"):
            search.run()
        assert bus.read_state().torque_on is (wanted == 1)


@pytest.mark.real_time
@pytest.mark.parametrize("maker", SERVOS)
def test_one_finger_is_homed_through_the_makers_sdk(maker):
    """Three servos behind a pseudo terminal, six times as fast as real ones."""
    limits = hand_limits(
        names=NAMES[:3], **{key: getattr(hand_limits(), key)[:3] for key in COLUMNS}
    )
    gears = Transmission(GEARS.matrix[:3, :3], np.zeros(3))
    there = Mounting(np.array([-0.9, -0.2, -0.4]), np.ones(3), np.ones(3))
    bench, bus, model = SERVOS[maker]
    pace, numbers = 6.0, (1, 2, 3)
    with bench(TendonHand(gears, limits, np.array([0.4, 0.1, 0.6])), there, numbers) as servos:
        servos.pace = pace
        line = bus(MOTORS[:3], numbers, model, servos.port, 1_000_000)
        line.open()
        known = MotorMap(NAMES[:3], MOTORS[:3], gears, replace(there, zero_rad=np.zeros(3)))
        found = Homing(
            line,
            known,
            limits,
            clock=lambda: pace * time.monotonic(),
            sleep=lambda seconds: time.sleep(seconds / pace),
        ).run()
        line.close()
    assert np.abs(found.motors.mounting.zero_rad - there.zero_rad).max() < np.radians(1.5)
