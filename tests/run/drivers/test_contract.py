"""What every driver keeps: one suite for firmware, its simulator, simulated motors and servo buses."""

import time

import numpy as np
import pytest

from fpcad.run.errors import ControllerHeld, GoalRefused, LinkLost, PortMissing, WatchdogTripped
from tests.firmware.core import made
from tests.firmware.lateness import judged_fairly
from tests.run.drivers.rigs import CONTROLLERS, DRIVERS, SERVOS, rig, unplug

pytestmark = [pytest.mark.filterwarnings("error"), pytest.mark.real_time]


@pytest.fixture(params=DRIVERS)
def driver(request):
    if request.param == "firmware":
        made("host")
    with rig(request.param) as there:
        judged_fairly(there.bus.open, request.param)
        yield there
        there.bus.close()


@pytest.fixture
def pulling(driver):
    driver.bus.torque(True)
    return driver


def test_each_axis_says_who_it_is(driver):
    who = driver.bus.identify()
    assert tuple(one.axis for one in who) == driver.bus.names
    assert all(one.model and one.firmware for one in who)
    assert len({one.number for one in who}) == len(who)


def test_opening_moves_nothing(driver):
    before = driver.bus.read_state().position_rad
    time.sleep(0.05)
    assert np.abs(driver.bus.read_state().position_rad - before).max() < 0.002


def test_a_state_has_a_number_for_each_axis(driver):
    state = driver.bus.read_state()
    for column in (state.position_rad, state.current_ma, state.temperature_c):
        assert column.shape == (12,) and np.isfinite(column).all()
    assert (state.current_ma >= 0).all() and state.bad_frames == 0


def test_torque_comes_without_a_jump(driver):
    """The servos' registers hold a stale goal, two radians away."""
    before = driver.bus.read_state().position_rad
    driver.bus.torque(True)
    time.sleep(0.1)
    state = driver.bus.read_state()
    assert state.torque_on and np.abs(state.position_rad - before).max() < 0.003


def test_goals_are_followed(pulling):
    goal = pulling.bus.read_state().position_rad + 0.05 * np.linspace(-1, 1, 12)
    assert np.abs(pulling.go(goal) - goal).max() < 0.01


def test_without_torque_nothing_follows(pulling):
    pulling.bus.torque(False)
    before = pulling.bus.read_state()
    assert not before.torque_on
    pulling.bus.torque(False)
    if pulling.kind in CONTROLLERS:
        with pytest.raises(ControllerHeld, match="ESTOP"):
            pulling.bus.write_goals(before.position_rad + 0.01)
    else:
        pulling.bus.write_goals(before.position_rad + 0.1)
    time.sleep(0.1)
    after = pulling.bus.read_state().position_rad
    assert np.abs(after - before.position_rad).max() < 0.002


def test_torque_comes_back_where_the_axes_are(pulling):
    pulling.bus.torque(False)
    pulling.bus.torque(True)
    goal = pulling.bus.read_state().position_rad + 0.03
    assert np.abs(pulling.go(goal) - goal).max() < 0.01


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -1e9], ids=str)
def test_goals_that_are_none_are_refused(pulling, wrong):
    before = pulling.bus.read_state().position_rad
    goal = before + 0.02
    goal[4] = wrong
    if wrong == -1e9 and pulling.kind == "sim":
        pytest.skip("simulated motors turn without end")
    with pytest.raises(GoalRefused, match=r"nothing was sent"):
        pulling.bus.write_goals(goal)
    with pytest.raises(GoalRefused, match=r"nothing was sent"):
        pulling.bus.write_goals(before[:5])
    time.sleep(0.05)
    assert np.abs(pulling.bus.read_state().position_rad - before).max() < 0.003


def test_a_silent_host_is_noticed_or_the_driver_says_that_it_is_not(pulling):
    can = pulling.bus.watchdog(0.5)
    assert can is pulling.watches
    bus = pulling.bus
    start = bus.read_state().position_rad
    # A controller stops only what moves: its joints have a long way ahead of them.
    way = np.tile([1.0, 0, 1.0], 4) * (pulling.kind in CONTROLLERS)
    bus.write_goals(start + way)
    while way.any() and bus.read_state().position_rad[0] < start[0] + 0.02:
        pass
    time.sleep(0.9)
    if not can:
        assert "keep their last goal" in bus.without_host
        bus.read_state()
        return
    with pytest.raises(WatchdogTripped, match="heard nothing"):
        pulling.stay(100)
    bus.torque(False)
    bus.torque(True)
    assert bus.watchdog(0.5)
    goal = bus.read_state().position_rad + 0.02
    assert np.abs(pulling.go(goal) - goal).max() < 0.01


def test_a_closed_bus_says_so_and_opens_again(driver):
    driver.bus.close()
    driver.bus.close()
    with pytest.raises(PortMissing, match="closed"):
        driver.bus.read_state()
    if driver.kind not in CONTROLLERS:  # those end with their line
        driver.bus.open()
        assert driver.bus.read_state().position_rad.shape == (12,)


@pytest.mark.parametrize("kind", [*CONTROLLERS, *SERVOS])
def test_an_unplugged_adapter_is_noticed_within_a_second(kind):
    if kind == "firmware":
        made("host")
    with rig(kind) as there:
        there.bus.open()
        there.bus.torque(True)
        there.bus.read_state()
        unplug(there)
        begin = time.monotonic()
        with pytest.raises(LinkLost, match=r"line broke.*unplugged") as caught:
            there.stay(1000)
        assert time.monotonic() - begin < 1.0
        assert str(caught.value).endswith(there.bus.without_host)
        there.bus.close()
