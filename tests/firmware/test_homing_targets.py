"""Homing on every target: one finger, its motors' zeros unknown, its joints between end stops.

A process of this machine and QEMU's Cortex-M3 simulate motors and tendons. An AVR has no time for that, so its
motors are ideal but for the stops.
"""

import time
from contextlib import ExitStack, closing
from types import SimpleNamespace

import numpy as np
import pytest

from fpcad.run.limits import from_counts
from fpcad.run.messages import (
    Ack,
    Arm,
    AskHoming,
    End,
    Hold,
    Home,
    HomingOutcome,
    HomingReport,
    Knot,
    Ping,
    Pong,
    Refused,
    State,
    Telemetry,
)
from fpcad.run.port import open_port
from fpcad.run.sim.spawn import firmware_process
from tests.firmware.core import made
from tests.firmware.targets import SETUPS, BuiltHand, running
from tests.firmware.test_transmission import BLOCK
from tests.firmware.wire import WireBench
from tests.run.fixtures import NAMES, hand_limits

ZERO_ERROR = np.array([-0.6, 0.3, 0.5])
OFFSET = np.array([-1.0, 0.2, 1.0])
YAML = f"""joints: [{", ".join(NAMES[:3])}]
matrix: {BLOCK.tolist()}
offset_rad: {OFFSET.tolist()}
""".encode()


def finger_limits():
    whole = hand_limits()
    box = ("lower_rad", "upper_rad", "velocity_rad_s", "acceleration_rad_s2")
    return hand_limits(
        names=NAMES[:3], configuration=YAML, **{key: getattr(whole, key)[:3] for key in box}
    )


UNHOMED = {"homed": False, "homing_speed_rad_s": 3.0}
FINGER = BuiltHand("build/finger", finger_limits(), np.array([0.3, 0.1, 0.2]), ZERO_ERROR, UNHOMED)
IMAGES = {"mps2_an385": "mps2_an385.elf", "avr": "avr_stops.elf"}


@pytest.fixture(scope="module", params=["fw", *SETUPS])
def port(request):
    """A finger that has just got its power."""
    with ExitStack() as stack:
        if request.param in SETUPS:
            yield stack.enter_context(running(request.param, IMAGES[request.param], FINGER))
            return
        made("host")
        limits, start = FINGER.limits, FINGER.start_rad
        yield stack.enter_context(
            firmware_process(limits, start, clock_rate=4.0, zero_error_rad=ZERO_ERROR, **UNHOMED)
        ).port


def searched(bench):
    """Ask for homing, stay in touch until it is over: what is told of it, and the states on the way."""
    bench.open()
    assert isinstance(bench.ask(Home()), Ack)
    states, deadline = [bench.now().state], time.monotonic() + 60
    while states[-1] == State.HOMING and time.monotonic() < deadline:
        assert isinstance(bench.ask(Ping(1)), Pong)
        states.append(bench.now().state)
    return bench.ask(AskHoming()), states


@pytest.fixture(scope="module")
def search(port):
    with closing(open_port(port)) as line:
        bench = WireBench(line)
        welcome, too_early = bench.open(), bench.ask(Arm())
        report, states = searched(bench)
        yield SimpleNamespace(
            bench=bench, welcome=welcome, too_early=too_early, states=states, report=report
        )


def test_a_finger_with_unknown_zeros_says_so_and_does_not_arm(search):
    assert search.welcome.homed == 0
    assert isinstance(search.too_early, Refused) and search.too_early.state == State.IDLE


def test_zeros_and_both_ends_are_found(search):
    report = search.report
    assert search.states[-1] == State.READY and report.outcome == HomingOutcome.FOUND
    wrong = from_counts(report.offset_urad) - (OFFSET + ZERO_ERROR)
    assert np.abs(np.linalg.solve(BLOCK, wrong)).max() < np.radians(1.0)
    for found, limit in ((report.lower_urad, FINGER.limits.lower_rad - 0.03),
                         (report.upper_urad, FINGER.limits.upper_rad + 0.03)):  # fmt: skip
        assert np.abs(from_counts(found) - limit).max() < 0.04


def test_the_finger_is_straight_and_follows_a_path_then(search):
    bench = search.bench
    assert bench.open().homed == 1
    rests = bench.now().command_urad
    assert np.abs(from_counts(rests)).max() < 0.06
    lower = FINGER.limits.on_wire().lower_urad
    straight = tuple(np.maximum(rests, lower).tolist())  # an encoder may see it just beyond
    still = (0,) * 3
    bent = tuple(count + 100_000 for count in straight)
    path = (Knot(0, straight, *[still] * 3), Knot(1_000_000, bent, *[still] * 3))
    bench.into(State.RUNNING, (*path, End(2)))
    ended = bench.stay_until(lambda m: isinstance(m, Telemetry) and m.state == State.READY)
    assert np.abs(from_counts(ended.position_urad) - from_counts(bent)).max() < 0.02


def test_a_search_that_is_held_leaves_the_zeros_unknown(search):
    """The last one at each port."""
    bench = search.bench
    bench.into(State.READY, ())
    assert isinstance(bench.ask(Home()), Ack)
    answer = bench.ask(Hold())
    assert isinstance(answer, Ack) and answer.state == State.IDLE
    assert bench.ask(AskHoming()).outcome == HomingOutcome.STOPPED
    assert isinstance(bench.ask(Arm()), Refused)


def test_a_joint_that_meets_no_stop_is_a_fault_on_an_avr():
    with running("avr", "avr.elf", FINGER) as name, closing(open_port(name)) as line:
        report, states = searched(WireBench(line))
    assert isinstance(report, HomingReport)
    assert (report.outcome, report.joint) == (HomingOutcome.NO_END, 0)
    assert states[-1] == State.FAULT
