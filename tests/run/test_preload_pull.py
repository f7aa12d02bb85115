"""Stiffness and slack behind the firmware; the truth is its simulated tendons'."""

import numpy as np
import pytest

from fpcad.run.drivers.feetech import FeetechBus
from fpcad.run.firmware import FirmwareDriver
from fpcad.run.messages import State
from fpcad.run.preload_pull import PreloadPull
from fpcad.run.transmission import read_transmission
from tests.firmware.core import core_controller
from tests.firmware.test_transmission import BLOCK, YAML
from tests.run.drivers.rigs import MOTORS
from tests.run.fixtures import NAMES, hand_limits
from tests.run.virtual import VirtualLine

LIMITS = hand_limits(configuration=YAML)
TENDON, STOP, GAIN = 30.0, 200.0, 20.0
"""Stiffness [N m/rad] of the tendons, end stops and servos of firmware_host/plant/motor_tendon.c."""
SERVO = FeetechBus.models[777]
CURRENT = SERVO.stall_nm / SERVO.stall_ma / 1.07e-3
"""How much more torque for its current the servo of the catalogue has than the simulated one."""


def pulls(*mishaps):
    line = VirtualLine(core_controller(limits=LIMITS, start_rad=np.tile([0.5, 0.0, 0.6], 4)))
    for kind, number in mishaps:
        line.device.mishap(kind, number)
    driver = FirmwareDriver(line, LIMITS, line.clock)
    gears = read_transmission(YAML, NAMES)
    return line, PreloadPull(driver, MOTORS, LIMITS, gears, SERVO)


def grasped():
    return [("grasp", joint) for joint in range(12)]


def test_stiffness_is_the_tendons_and_the_end_stops_in_series():
    """But for the finger whose MCP meets no stop: nothing is told of the motors that pull it."""
    line, test = pulls(("no_stop", 9), ("no_stop", 10))
    before = line.device.plant.position
    found = test.stiffness()
    # Both motors of the flexion press on its stop. The IP joint's is pressed by half of m3's turn, and
    # what the tendon pulls at the MCP that it crosses, two servos and their tendons hold.
    flexion = 1 / TENDON + 2 / STOP
    crossing = BLOCK[2, 0] ** 2 * (1 / GAIN + 1 / TENDON) / 2
    yields = np.tile([flexion, flexion, 1 / TENDON + BLOCK[2, 2] ** 2 / STOP + crossing], 4)
    wanted = CURRENT / yields
    wanted[[9, 10]] = np.nan
    assert found == pytest.approx(wanted, rel=0.03, nan_ok=True)
    assert line.device.state is State.READY
    np.testing.assert_allclose(line.device.plant.position, before, atol=0.01)
    np.testing.assert_allclose(line.device.follower.preload, 0)


@pytest.mark.parametrize(("loose", "slack_rad"), [([], 0.0), ([("slack", 4)], 0.12)])
def test_slack_of_a_loop_is_found_while_a_hand_holds_the_finger(loose, slack_rad):
    _, test = pulls(*grasped(), *loose)
    found = test.slack(4)
    assert found.motor == "index_m2"
    assert found.slack_rad == pytest.approx(slack_rad, abs=0.006)
    assert found.stiffness_nm_rad == pytest.approx(CURRENT * TENDON, rel=0.05)


def test_a_nod_bends_one_joint_and_brings_it_back():
    line, test = pulls()
    before, seen = line.device.plant.position, []
    line.on_tick = lambda line: seen.append(line.device.plant.position)
    test.nod(3)
    way = np.ptp(seen, axis=0)
    assert way[3] == pytest.approx(0.5, abs=0.02) and np.delete(way, 3).max() < 0.05
    np.testing.assert_allclose(line.device.plant.position, before, atol=0.01)
