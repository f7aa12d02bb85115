"""What the firmware's guards do when motors fail, on its core in virtual time."""

import subprocess

import numpy as np
import pytest

from fpcad.run.errors import ControllerFault
from fpcad.run.firmware_setup import TRACKING_LIMIT_RAD
from fpcad.run.messages import Cause, State
from fpcad.run.quintic import Knots
from tests.firmware.core import DEATH, HEAT, JAM, STUCK, core_controller, made
from tests.run.fixtures import hand_limits, swing
from tests.run.streaming import at, run
from tests.run.virtual import VirtualLine

MOTION = swing(2.0, 51, amplitude=0.25)
QUICK = hand_limits(velocity_rad_s=np.full(12, 4.0), acceleration_rad_s2=np.full(12, 90.0))


def quick_motion():
    """The swing with 1.5 rad/s at most in its third joints."""
    slow = swing(1.2, 31, amplitude=0.25)
    pace = 1.5 / np.abs(slow.velocity[:, 5]).max()
    return Knots(
        slow.time_s / pace, slow.position, slow.velocity * pace, slow.acceleration * pace**2
    )


class Blackbox:
    """Lets one thing go wrong at 1 s and notes what follows."""

    def __init__(self, mishap, motor):
        self.fault_s: float = 0.0
        self.over_limit_s: float = 0.0
        self.largest_error: float = 0.0
        self._fail = at(1.0, lambda line: line.device.mishap(mishap, motor))

    def __call__(self, line):
        self._fail(line)
        device, now = line.device, line.now_s
        error = np.abs(device.measured - device.follower.command).max()
        if not self.fault_s:
            self.largest_error = max(self.largest_error, error)
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


def test_too_much_current_is_a_fault_within_20_ms():
    line = VirtualLine(core_controller(current_ma=300))
    seen, jam = {}, at(1.0, lambda line: line.device.mishap(JAM, 3))

    def note(line):
        jam(line)
        device = line.device
        if np.abs(device.look().current_ma).max() > 300:
            seen.setdefault("strained", line.now_s)
        if device.state is State.FAULT:
            seen.setdefault("fault", line.now_s)

    line.on_tick = note
    with pytest.raises(ControllerFault, match="current"):
        run(line, MOTION)
    line.let_pass(0.2)
    assert line.device.cause is Cause.CURRENT
    assert 0 < seen["fault"] - seen["strained"] <= 0.020


@pytest.mark.parametrize("mishap", [STUCK, JAM])
def test_what_stands_still_is_a_fault_within_20_ms_at_full_speed(mishap):
    line = VirtualLine(core_controller(limits=QUICK))
    moving, failed = [], []

    def note(line):
        follower = line.device.follower
        speed = abs(line.device.look().command_velocity[5])
        if line.device.state is State.RUNNING and speed > 1.3e6 and not moving:
            line.device.mishap(mishap, 5)
            moving.append((line.now_s, follower.path_us))
        if line.device.state is State.FAULT and not failed:
            failed.append(line.now_s)

    line.on_tick = note
    with pytest.raises(ControllerFault, match="index_ip_flex does not follow"):
        run(line, quick_motion(), limits=QUICK)
    assert line.device.cause is Cause.TRACKING
    assert 0 < failed[0] - moving[0][0] < 0.0201


def test_a_slow_motion_stops_before_its_goal_is_two_degrees_ahead():
    line, box, message = failed_run(STUCK)
    assert line.device.cause is Cause.TRACKING and "index_mcp_flex" in message
    assert box.largest_error < np.radians(2.0)


def test_a_motor_that_gives_way_is_a_fault_beyond_the_tracking_limit():
    line = VirtualLine(core_controller(limits=QUICK))
    line.on_tick = box = Blackbox("weak", 3)
    with pytest.raises(ControllerFault, match="index_mcp_flex"):
        run(line, quick_motion(), limits=QUICK)
    assert box.largest_error > TRACKING_LIMIT_RAD
    assert 0 <= box.fault_s - box.over_limit_s <= 0.020


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


@pytest.mark.parametrize("seed", [1])
def test_anything_on_the_line_is_survived(seed):
    fuzz = made("fuzz") / "fuzz"
    done = subprocess.run([fuzz, "10000000", str(seed)], capture_output=True, text=True)
    print(done.stdout)
    assert done.returncode == 0, done.stderr
