"""Stiffness and slack of tendons, as their motors tell; the truth is the simulated hand's."""

import numpy as np
import pytest

from fpcad.run.drivers.sim import SimBus
from fpcad.run.pull_test import PullTest
from tests.run.drivers.rigs import MOTORS, motor_map, mounting, tendon_hand
from tests.run.drivers.test_servo_driver import Time
from tests.run.fixtures import hand_limits


def pulls(**physics):
    clock = Time()
    hand = tendon_hand(**physics)
    bus = SimBus(MOTORS, hand, mounting(), clock.clock)
    bus.open()
    bus.torque(True)
    return hand, PullTest(bus, motor_map(), hand_limits(), clock.clock, clock.sleep)


def test_stiffness_is_found_within_five_percent():
    _, test = pulls(stiffness_nm_rad=9.0)
    found = test.stiffness()
    assert np.isfinite(found).all()
    assert found == pytest.approx(9.0, rel=0.05)


@pytest.mark.parametrize("slack_rad", [0.0, 0.06])
def test_slack_is_found_within_a_third_of_a_degree(slack_rad):
    hand, test = pulls(slack_rad=slack_rad)
    hand.lock(True)
    found = test.slack(4)
    assert found.motor == "index_m2"
    assert found.slack_rad == pytest.approx(2 * slack_rad, abs=0.006)
    assert found.stiffness_nm_rad == pytest.approx(12.0, rel=0.05)
