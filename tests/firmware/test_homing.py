"""How the firmware finds its motors' zeros, on its core with simulated tendons and end stops."""

import zlib
from types import SimpleNamespace

import numpy as np
import pytest

from fpcad.run.codec import encode
from fpcad.run.limits import from_counts
from fpcad.run.messages import (
    Ack,
    Arm,
    AskHoming,
    Calibrate,
    Cause,
    Clear,
    Estop,
    Hello,
    Hold,
    Home,
    HomingOutcome,
    Ping,
    Reason,
    Refused,
    State,
)
from fpcad.run.transmission import read_transmission
from tests.firmware.core import CoreController, core_controller
from tests.firmware.test_transmission import BLOCK, YAML
from tests.run.fixtures import NAMES, hand_limits, swing
from tests.run.test_states import Bench

LIMITS = hand_limits(configuration=YAML)
GEARS = read_transmission(YAML, NAMES)
ZERO_ERROR = np.linspace(-0.6, 0.5, 12)
"""How far the motors' zeros are off: spools are put on at any angle."""


class HomingBench(Bench):
    """The bench of the state table, with a hand whose zeros are unknown."""

    def __init__(self, **changes):
        setup = {
            "limits": LIMITS,
            "homed": False,
            "homing_speed_rad_s": 2.0,
            "zero_error_rad": ZERO_ERROR,
            "buffer_knots": 32,
        }
        self.device: CoreController = core_controller(**{**setup, **changes})
        self.seq = 0
        self.welcome = self.ask(Hello())

    def homed(self, patience_s=60.0) -> SimpleNamespace:
        """Ask for homing and wait until it is over; the way that the joints took."""
        assert isinstance(self.ask(Home()), Ack)
        rows, tick = [], 0
        while self.device.state is State.HOMING and tick < patience_s * 250:
            self.device.tick()
            rows.append(self.device.plant.position)
            if tick % 50 == 0:
                self.ask(Ping(1))
            tick += 1
        return SimpleNamespace(way=np.array(rows), seconds=tick / 250, report=self.ask(AskHoming()))


@pytest.fixture(scope="module")
def search():
    bench = HomingBench()
    return SimpleNamespace(bench=bench, **vars(bench.homed()))


def test_zeros_are_found_within_a_degree(search):
    assert search.report.outcome == HomingOutcome.FOUND
    wrong = from_counts(search.report.offset_urad) - (GEARS.offset_rad + ZERO_ERROR)
    assert np.abs(np.linalg.solve(GEARS.matrix, wrong)).max() < np.radians(1.0)
    device = search.bench.device
    assert np.abs(device.measured - device.plant.position).max() < np.radians(1.0)


def test_the_hand_is_ready_and_straight_afterwards(search):
    device = search.bench.device
    assert device.state is State.READY and device.cause is Cause.NONE
    assert device.plant.torque_on
    assert np.abs(device.plant.position).max() < 0.05
    assert np.abs(device.follower.command - device.measured).max() < 0.02


def test_both_ends_are_reported_where_the_stops_are(search):
    stops = LIMITS.lower_rad - 0.03, LIMITS.upper_rad + 0.03
    for found, stop in zip((search.report.lower_urad, search.report.upper_urad), stops, strict=True):  # fmt: skip
        assert np.abs(from_counts(found) - stop).max() < 0.04


def test_one_joint_moves_at_a_time_and_the_ip_joint_is_kept_still_by_c1(search):
    abduction_begins = int(np.argmax(np.abs(search.way[:, 1]) > 0.05))
    flexing = search.way[:abduction_begins]
    assert np.ptp(flexing[:, 0]) > 1.9
    assert np.ptp(flexing[:, 2]) < 0.3  # without m3, 0.8 of 1.9 rad
    assert np.ptp(flexing[:, 3:], axis=0).max() < 1e-3


def test_a_homed_controller_names_its_zeros(search):
    bench = search.bench
    bench.seq = 0
    welcome = bench.ask(Hello(), session=77)
    zeros = Calibrate(bench.ask(AskHoming(), session=77).offset_urad)
    assert (welcome.homed, welcome.calibration) == (1, zlib.crc32(encode(zeros)))


def test_an_unhomed_controller_says_so_and_does_not_arm():
    bench = HomingBench()
    assert (bench.welcome.homed, bench.welcome.calibration) == (0, 0)
    answer = bench.ask(Arm())
    assert isinstance(answer, Refused) and answer.state == State.IDLE


def test_little_current_is_all_that_homing_uses():
    bench = HomingBench(homing_ma=250)
    assert isinstance(bench.ask(Home()), Ack)
    drawn = []
    for tick in range(1500):
        bench.device.tick()
        if tick % 50 == 0:
            bench.ask(Ping(1))
        drawn.append(np.abs(bench.device.look().current_ma).max())
    assert 200 < max(drawn) <= 250


@pytest.mark.parametrize(
    ("mishap", "number", "outcome", "joint"),
    [
        ("wedge", 0, HomingOutcome.WRONG_RANGE, 0),
        ("wedge", 4, HomingOutcome.WRONG_RANGE, 4),
        ("wedge", 2, HomingOutcome.WRONG_RANGE, 2),
        ("no_stop", 3, HomingOutcome.NO_END, 3),
        ("reversed", 0, HomingOutcome.WRONG_RANGE, 0),
        ("reversed", 4, HomingOutcome.WRONG_RANGE, 3),
    ],
)
def test_what_does_not_fit_the_design_is_a_fault_at_that_joint(mishap, number, outcome, joint):
    bench = HomingBench()
    bench.device.mishap(mishap, number)
    report = bench.homed().report
    assert (report.outcome, report.joint) == (outcome, joint)
    assert bench.device.state is State.FAULT and bench.device.cause is Cause.HOMING
    assert not bench.device.plant.torque_on
    assert report.lower_urad[joint + 1 :] == (0,) * (11 - joint)
    assert isinstance(bench.ask(Clear()), Ack) and bench.device.state is State.IDLE


@pytest.mark.parametrize("motors", [(2,), (0, 1)], ids=["m3", "m1 and m2"])
def test_motors_that_turn_the_wrong_way_are_found(motors):
    bench = HomingBench()
    for motor in motors:
        bench.device.mishap("reversed", motor)
    report = bench.homed().report
    assert report.outcome in (HomingOutcome.WRONG_SIGN, HomingOutcome.WRONG_RANGE)
    assert report.joint in (0, 2) and bench.device.state is State.FAULT


@pytest.mark.parametrize(
    ("stop", "state"), [(Hold(), State.IDLE), (Estop(), State.ESTOP), (None, State.IDLE)]
)
def test_a_search_is_broken_off_limp(stop, state):
    bench = HomingBench()
    bench.ask(Home())
    for _ in range(100):
        bench.device.tick()
    if stop is None:
        for _ in range(150):
            bench.device.tick()
        assert bench.device.cause is Cause.SILENCE
    else:
        bench.ask(stop)
    assert bench.device.state is state and not bench.device.plant.torque_on
    assert bench.ask(AskHoming()).outcome == HomingOutcome.STOPPED
    assert isinstance(bench.ask(Arm()), Refused)


def test_a_motor_that_dies_in_a_search_is_a_fault():
    bench = HomingBench()
    bench.ask(Home())
    bench.device.mishap("death", 7)
    for _ in range(5):
        bench.device.tick()
    assert (bench.device.state, bench.device.cause) == (State.FAULT, Cause.MOTOR_LOST)
    assert bench.ask(AskHoming()).outcome == HomingOutcome.STOPPED


def zeros_of(error_rad):
    return Calibrate(tuple(np.rint((GEARS.offset_rad + error_rad) * 1e6).astype(int).tolist()))


def test_zeros_that_the_host_has_kept_make_the_hand_ready():
    bench = HomingBench()
    assert isinstance(bench.ask(zeros_of(ZERO_ERROR)), Ack)
    device = bench.device
    assert device.state is State.READY and device.plant.torque_on
    np.testing.assert_allclose(device.measured, device.plant.position, atol=3e-6)
    before = device.plant.position
    for _ in range(50):
        device.tick()
    np.testing.assert_allclose(device.plant.position, before, atol=1e-3)  # nothing jumps
    assert bench.ask(AskHoming()).outcome == HomingOutcome.CALIBRATED


@pytest.mark.parametrize("joint", [0, 4, 11])
def test_implausible_zeros_are_refused_and_change_nothing(joint):
    bench = HomingBench()
    error = ZERO_ERROR.copy()
    finger = slice(joint // 3 * 3, joint // 3 * 3 + 3)
    error[finger] += 2.5 * BLOCK[:, joint % 3]
    answer = bench.ask(zeros_of(error))
    assert isinstance(answer, Refused)
    assert (answer.reason, answer.joint) == (Reason.IMPLAUSIBLE, joint)
    assert bench.device.state is State.IDLE and not bench.device.plant.torque_on


def test_zeros_beyond_three_turns_or_of_another_hand_are_refused():
    far = tuple([30_000_000] + [0] * 11)
    assert HomingBench().ask(Calibrate(far)).reason == Reason.IMPLAUSIBLE
    assert HomingBench().ask(Calibrate((0,) * 11)).reason == Reason.MALFORMED


def test_a_hand_can_be_homed_again_from_ready():
    bench = HomingBench(homed=True, zero_error_rad=np.zeros(12), start_rad=swing().position[0])
    assert isinstance(bench.ask(Home()), Ack)
    assert bench.device.state is State.HOMING
    bench.ask(Hold())
    assert isinstance(bench.ask(Arm()), Refused)  # what is half searched is not known
