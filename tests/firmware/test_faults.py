"""What the firmware's guards do when motors fail, on its core in virtual time."""

import subprocess

import numpy as np
import pytest

from fpcad.run.errors import ControllerFault
from fpcad.run.firmware_setup import TRACKING_LIMIT_RAD
from fpcad.run.messages import Cause, State
from tests.firmware.core import DEATH, HEAT, JAM, STUCK, core_controller, made
from tests.run.fixtures import hand_limits, swing
from tests.run.test_stream import at, run
from tests.run.virtual import VirtualLine

MOTION = swing(2.0, 51, amplitude=0.25)


class Blackbox:
    """Lets one thing go wrong at 1 s and notes what follows."""

    def __init__(self, mishap, motor):
        self.fault_s: float = 0.0
        self.over_limit_s: float = 0.0
        self._fail = at(1.0, lambda line: line.device.mishap(mishap, motor))

    def __call__(self, line):
        self._fail(line)
        device, now = line.device, line.now_s
        error = np.abs(device.measured - device.follower.command).max()
        if not self.over_limit_s and error > TRACKING_LIMIT_RAD:
            self.over_limit_s = now
        if not self.fault_s and device.state is State.FAULT:
            self.fault_s = now


def failed_run(mishap, motor=3, **setup):
    line = VirtualLine(core_controller(**setup))
    line.on_tick = box = Blackbox(mishap, motor)
    with pytest.raises(ControllerFault) as caught:
        run(line, MOTION)
    line.let_pass(0.5)
    return line, box, str(caught.value)


@pytest.mark.parametrize(
    ("mishap", "setup", "cause"),
    [
        (DEATH, {}, Cause.MOTOR_LOST),
        (HEAT, {"temperature_c": 70}, Cause.TEMPERATURE),
    ],
)
def test_a_failing_motor_is_a_fault_within_20_ms(mishap, setup, cause):
    line, box, message = failed_run(mishap, **setup)
    assert line.device.cause is cause and cause.name.lower() in message
    assert box.fault_s - 1.0 <= 0.020
    assert line.device.state is State.FAULT and line.device.follower.rate == 0


def test_too_much_current_is_a_fault():
    line, _, _ = failed_run(JAM, current_ma=600)
    assert line.device.cause is Cause.CURRENT


@pytest.mark.parametrize("mishap", [STUCK, JAM])
def test_what_does_not_follow_is_a_fault_as_soon_as_it_shows(mishap):
    line, box, message = failed_run(mishap)
    assert line.device.cause is Cause.TRACKING and "index_mcp_flex" in message
    assert box.fault_s - box.over_limit_s <= 0.020


def test_the_others_slow_down_along_the_path_and_hold():
    line, _, _ = failed_run(DEATH)
    assert line.device.plant.torque_on
    held = np.delete(np.abs(line.device.plant.position - line.device.follower.command), 3)
    assert held.max() < 0.01


def test_a_fault_is_latched_and_comes_back_while_its_cause_lasts():
    line, _, _ = failed_run(DEATH)
    line.device.state = State.READY
    line.let_pass(0.1)
    assert line.device.state is State.FAULT


def test_a_motor_that_dies_at_rest_is_noticed_too():
    device = core_controller()
    device.mishap(DEATH, 0)
    device.tick()
    assert device.state is State.READY  # one missed answer stops nothing
    device.tick()
    assert device.state is State.FAULT


def test_torque_is_off_at_power_on_until_the_motors_are_known():
    device = core_controller(homed=False)
    assert not device.plant.torque_on and device.state is State.IDLE


def test_a_build_that_no_controller_can_be_made_of_is_named():
    with pytest.raises(AssertionError, match="tick_hz: must divide"):
        core_controller(tick_hz=300)
    with pytest.raises(AssertionError, match="buffer_knots: out of range"):
        core_controller(buffer_knots=7000, limits=hand_limits())


@pytest.mark.parametrize("seed", range(1, 3))
def test_anything_on_the_line_is_survived(seed):
    fuzz = made("fuzz") / "fuzz"
    done = subprocess.run([fuzz, "2000000", str(seed)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
