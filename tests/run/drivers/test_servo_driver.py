"""Trajectories on servo buses: the makers' SDKs, simulated servos, real time."""

import time

import numpy as np
import pytest

from fpcad.run.driver import Watch
from fpcad.run.drivers.sim import SimBus
from fpcad.run.errors import (
    CalibrationError,
    CommandRefused,
    HeldByUser,
    LinkLost,
    ServoFault,
    ServoSilent,
    StoppedByUser,
)
from fpcad.run.quintic import Knots
from fpcad.run.run_trajectory import follow
from fpcad.run.servo_driver import ServoDriver
from fpcad.run.servo_guard import ServoGuards
from tests.run.drivers.rigs import (
    MOTORS,
    SERVOS,
    motor_map,
    mounting,
    servo_bench,
    servo_bus,
    tendon_hand,
)
from tests.run.fixtures import NAMES, hand_limits, swing
from tests.run.virtual import bit_flips

GUARDS = ServoGuards(current_ma=2000)


class Time:
    """A clock that only sleeping moves."""

    def __init__(self):
        self.now_s = 0.0

    def clock(self):
        return self.now_s

    def sleep(self, seconds):
        self.now_s += seconds


def simulated(clock, **guards):
    bus = SimBus(MOTORS, tendon_hand(), mounting(), clock.clock)
    bus.open()
    made = ServoDriver(
        bus,
        motor_map(),
        hand_limits(),
        ServoGuards(**{"current_ma": 2000, **guards}),
        clock.clock,
        clock.sleep,
    )
    return bus, made


def played(driver, knots, on_sample=lambda _: None, stops=lambda: 0):
    return driver.play(knots, Watch(on_sample, stops))


def test_simulated_motors_follow_a_trajectory():
    bus, driver = simulated(Time())
    assert np.abs(driver.ready(clear=False).position_rad - swing().position[0]).max() < 1e-9
    report = follow(driver, [swing()], NAMES)
    assert report.final_state == "READY" and report.max_error_all_rad < 0.05
    assert np.abs(bus.hand.joint_rad - swing().position[-1]).max() < 0.01


def test_a_host_that_was_stalled_goes_on_without_a_jump():
    clock, seen = Time(), []
    _, driver = simulated(clock)
    driver.ready(clear=False)

    def stall(sample):
        seen.append(sample.command_rad)
        if len(seen) == 60:
            clock.now_s += 0.2

    played(driver, swing(), stall)
    steps = np.abs(np.diff(seen, axis=0)).max()
    assert driver.slipped_s == pytest.approx(0.18, abs=0.015)
    assert steps < 0.03 * np.radians(90)


def told_ends(samples):
    """States and causes of a run's table, each once, in their order."""
    return list(dict.fromkeys((sample.state, sample.cause) for sample in samples))


def test_one_request_holds_and_two_let_go():
    for wanted, error, on, state in (
        (1, HeldByUser, True, "HOLD"),
        (2, StoppedByUser, False, "ESTOP"),
    ):
        count, seen, samples = [0], [], []
        bus, driver = simulated(Time())
        driver.ready(clear=False)

        def at_half(sample, count=count, seen=seen, samples=samples, wanted=wanted):
            samples.append(sample)
            seen.append(sample.command_rad)
            count[0] = wanted * (sample.path_s > 1.0)

        with pytest.raises(error, match=r"at 1\.\d+ s of 2\.00 s"):
            played(driver, swing(), at_half, lambda count=count: count[0])
        assert bus.read_state().torque_on is on
        assert told_ends(samples) == [("RUNNING", "NONE"), (state, "HOST")]
        acceleration = np.abs(np.diff(seen[:-1], 2, axis=0)).max() / 0.01**2
        assert acceleration <= hand_limits().acceleration_rad_s2[0] * 1.1


def test_what_leaves_the_limits_is_refused_before_anything_moves():
    bus, driver = simulated(Time())
    driver.ready(clear=False)
    before = bus.hand.joint_rad
    too_far = swing(amplitude=3.0)
    with pytest.raises(CommandRefused, match="limit"):
        played(driver, too_far)
    assert np.abs(bus.hand.joint_rad - before).max() == 0


def test_a_start_elsewhere_is_refused():
    _, driver = simulated(Time())
    driver.ready(clear=False)
    knots = swing()
    away = Knots(knots.time_s, knots.position + 0.1, knots.velocity, knots.acceleration)
    with pytest.raises(CommandRefused, match="too far from start"):
        played(driver, away)


def test_a_joint_that_is_held_back_stops_all():
    bus, driver = simulated(Time())
    driver.ready(clear=False)
    knots = swing(amplitude=0.25)

    def block(sample):
        if sample.path_s > 0.5:
            bus.hand.lock(True)

    with pytest.raises(ServoFault, match=r"(does not follow|draws).*other joints slowed down"):
        played(driver, knots, block)


def test_a_current_beyond_the_bound_stops_all():
    _, driver = simulated(Time(), current_ma=20)
    driver.ready(clear=False)
    samples = []
    with pytest.raises(ServoFault, match=r"_m[123] draws \d+ mA at"):
        played(driver, swing(), samples.append)
    assert told_ends(samples) == [("RUNNING", "NONE"), ("FAULT", "CURRENT")]


@pytest.fixture(params=SERVOS)
def maker(request):
    return request.param


@pytest.fixture
def bench(maker):
    with servo_bench(maker) as there:
        yield there


@pytest.fixture
def driver(maker, bench):
    bus = servo_bus(maker, bench.port)
    bus.open()
    made = ServoDriver(bus, motor_map(), hand_limits(), GUARDS)
    made.bus = bus  # type: ignore[attr-defined]
    yield made
    bus.close()


def test_servos_follow_a_trajectory(driver, bench):
    driver.ready(clear=False)
    report = follow(driver, [swing(1.0, amplitude=0.03)], NAMES)
    assert report.max_error_all_rad < 0.1
    assert np.abs(bench.hand.joint_rad - swing().position[-1]).max() < 0.02
    assert report.bad_frames == 0


def test_after_power_came_back_a_turn_off_the_zeros_are_found(maker):
    if maker == "feetech":
        pytest.skip("counts one turn only")
    with servo_bench(maker, mounting(2 * np.pi - 0.7)) as bench:
        bus = servo_bus(maker, bench.port)
        bus.open()
        sample = ServoDriver(bus, motor_map(), hand_limits(), GUARDS).ready(clear=False)
        assert np.abs(sample.position_rad - bench.hand.joint_rad).max() < 0.01
        bus.close()


def test_a_spool_whose_range_crosses_the_encoders_end_is_not_moved():
    with servo_bench("feetech", mounting(2.0)) as bench:
        bus = servo_bus("feetech", bench.port)
        bus.open()
        driver = ServoDriver(bus, motor_map(mounting(2.0)), hand_limits(), GUARDS)
        with pytest.raises(CalibrationError, match=r"thumb_m1: .*end of its encoder.*half a turn"):
            driver.ready(clear=False)
        assert not any(bench.torque_on(n) for n in range(1, 13))
        bus.close()


def test_flipped_bits_cost_single_answers_and_nothing_else(driver, bench):
    driver.ready(clear=False)
    bench.faults.to_host = bit_flips(1e-4, seed=3)
    bench.faults.to_servos = bit_flips(1e-4, seed=4)
    report = follow(driver, [swing(1.0, amplitude=0.03)], NAMES)
    assert report.final_state == "READY" and report.bad_frames > 0
    assert np.abs(bench.hand.joint_rad - swing().position[-1]).max() < 0.02


def test_a_dead_servo_is_named_and_the_others_come_to_rest(driver, bench):
    driver.ready(clear=False)
    died, samples = [], []

    def die(sample):
        samples.append(sample)
        if sample.path_s > 0.3 and not died:
            died.append(time.monotonic())
            bench.faults.dead.add(5)

    with pytest.raises(ServoSilent, match=r"index_m2 \(id 5 on .*\) does not answer.*hold\.$"):
        played(driver, swing(), die)
    assert time.monotonic() - died[0] < 0.5
    assert told_ends(samples)[-1] == ("FAULT", "MOTOR_LOST")
    bench.pass_time()
    before = bench.hand.joint_rad
    time.sleep(0.05)
    bench.pass_time()
    assert np.abs(bench.hand.joint_rad - before).max() < 0.02


def test_an_unplugged_adapter_ends_the_run_and_says_what_the_servos_do(driver, bench):
    driver.ready(clear=False)

    samples = []

    def unplug(sample):
        samples.append(sample)
        if sample.path_s > 0.2:
            bench.unplug()

    with pytest.raises(LinkLost, match=r"the line broke.*Its servos") as caught:
        played(driver, swing(), unplug)
    assert str(caught.value).endswith(driver.bus.without_host)
    assert told_ends(samples)[-1] == ("FAULT", "LINK")


def test_a_hot_servo_stops_all(driver, bench):
    driver.ready(clear=False)
    bench.faults.temperature_c = 81
    samples = []
    with pytest.raises(ServoFault, match="is at 81 degrees C"):
        played(driver, swing(), samples.append)
    assert told_ends(samples)[-1] == ("FAULT", "TEMPERATURE")
