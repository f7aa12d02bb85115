"""Whole runs against the simulated controller, in time that passes only when it is waited for."""

import numpy as np
import pytest

from fpcad.run.driver import Watch
from fpcad.run.errors import (
    CommandRefused,
    ControllerFault,
    HeldByUser,
    NotReady,
    StartTooFar,
    StoppedByUser,
)
from fpcad.run.firmware import FirmwareDriver
from fpcad.run.link import MAX_IN_FLIGHT
from fpcad.run.messages import State
from fpcad.run.run_trajectory import follow
from fpcad.run.sim.controller import TICK_HZ
from tests.run.fixtures import NAMES, hand_limits, swing
from tests.run.streaming import KNOTS, Faithful, at, run
from tests.run.virtual import (
    VirtualLine,
    controller,
)

pytestmark = pytest.mark.usefixtures("each_controller")


@pytest.mark.parametrize("baud_rate", [None, 115_200])
def test_a_clean_line_needs_no_repeats(baud_rate):
    line = VirtualLine(baud_rate=baud_rate, on_tick=(faithful := Faithful()))
    driver = FirmwareDriver(line, hand_limits(), line.clock)
    driver.ready(clear=False)
    report = follow(driver, [KNOTS], NAMES)
    assert (report.knots, report.resends, report.bad_frames) == (101, 0, 0)
    assert report.final_state == "READY" and line.device.state is State.READY
    assert faithful.ticks == 4.0 * TICK_HZ - 1
    assert 0 < report.rms_error_all_rad < report.max_error_all_rad < 0.005
    assert max(report.max_error_rad) == report.max_error_all_rad
    np.testing.assert_allclose(line.device.plant.position, KNOTS.position[-1], atol=2e-3)


def test_no_more_is_on_the_way_than_bounds_a_stop():
    line = VirtualLine(baud_rate=115_200)
    sizes = []
    line.on_tick = lambda line: sizes.append(len(line._to_device))
    run(line)
    assert max(sizes) <= MAX_IN_FLIGHT


def test_a_far_start_is_refused_by_the_controller_too():
    start = KNOTS.position[0].copy()
    start[4] += np.radians(3)
    line = VirtualLine(controller(start_rad=start))
    with pytest.raises(StartTooFar, match="index_mcp_abd"):
        run(line)
    np.testing.assert_array_equal(line.device.plant.position, start)


def test_limits_are_the_controllers_to_keep():
    line = VirtualLine()
    driver = FirmwareDriver(line, hand_limits(), line.clock)
    driver.ready(clear=False)
    with pytest.raises(
        CommandRefused, match=r"refused Knot: (velocity|acceleration) limit \(\w+\)"
    ):
        driver.play(swing(0.5, 16, amplitude=0.4), Watch(lambda sample: None, lambda: 0))
    line.let_pass(0.5)
    np.testing.assert_array_equal(line.device.plant.position, KNOTS.position[0])


def test_a_jammed_joint_is_a_fault_that_names_it():
    line = VirtualLine()
    line.on_tick = at(1.0, lambda line: line.device.plant.jam(3))
    with pytest.raises(ControllerFault, match="index_mcp_flex does not follow"):
        run(line, swing(2.0, 51, amplitude=0.25))
    line.let_pass(0.5)
    assert line.device.state is State.FAULT and line.device.follower.rate == 0


def test_one_request_to_stop_holds_along_the_path():
    line = VirtualLine()
    with pytest.raises(HeldByUser, match=r"held at 0\.[89].* of 4\.00 s|held at 1\.0.* of 4\.00 s"):
        run(line, stops=lambda: int(line.now_s > 1.5))
    assert line.device.state is State.HOLD and line.device.plant.torque_on
    assert line.device.cause.name == "HOST"


@pytest.mark.parametrize("between_s", [0.0, 0.02])
def test_two_requests_to_stop_take_torque_off(between_s):
    line = VirtualLine()
    stops = lambda: int(line.now_s > 1.5) + int(line.now_s > 1.5 + between_s)  # noqa: E731
    with pytest.raises(StoppedByUser, match="torque is off"):
        run(line, stops=stops)
    assert line.device.state is State.ESTOP and not line.device.plant.torque_on


def test_an_error_of_the_callers_own_stops_the_joints():
    line = VirtualLine()
    driver = FirmwareDriver(line, hand_limits(), line.clock)
    driver.ready(clear=False)

    def complain(sample):
        if sample.path_s > 1:
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        driver.play(KNOTS, Watch(complain, lambda: 0))
    line.let_pass(0.3)
    assert line.device.state is State.HOLD and line.device.follower.rate == 0


def test_a_hold_is_latched_until_it_is_cleared():
    line = VirtualLine()
    with pytest.raises(HeldByUser):
        run(line, stops=lambda: int(line.now_s > 1.5))
    with pytest.raises(NotReady, match=r"HOLD because of host.*clear"):
        FirmwareDriver(line, hand_limits(), line.clock).ready(clear=False)
    again = FirmwareDriver(line, hand_limits(), line.clock)
    assert again.ready(clear=True).state == "READY"
