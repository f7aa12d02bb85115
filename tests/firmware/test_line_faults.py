"""Each kind of damage to the line by itself: every command stays what the knots say."""

import numpy as np
import pytest

from fpcad.run.driver import Watch
from fpcad.run.firmware import FirmwareDriver
from fpcad.run.knots import from_wire, to_wire
from fpcad.run.messages import Ack, Arm, Reason, State
from fpcad.run.quintic import evaluate
from tests.firmware.byte_log import Recorded, kept_on_failure, replayed
from tests.firmware.core import core_controller
from tests.firmware.cuts import DIRECTIONS, Cuts, bytes_of_a_session
from tests.firmware.line_faults import KINDS, FrameDamage
from tests.run.fixtures import hand_limits, swing
from tests.run.test_states import Bench, knot
from tests.run.virtual import VirtualLine, bit_flips

MOTION = swing(4.0, 101)
TICK_US = 4_000
_TICKS = np.arange(0, 4_000_001, TICK_US) / 1e6
WANTED = np.rint(evaluate(from_wire(to_wire(MOTION).messages), _TICKS).position * 1e6).astype(int)


def off_by(line):
    """Counts between the present command and the one that the knots say, at full pace."""
    view = line.device.look()
    if view.state != State.RUNNING or view.rate != 1:
        return 0
    return np.abs(np.array(view.command) - WANTED[view.path_us // TICK_US]).max()


def run_over(line, name):
    """The whole motion; every tick's command is checked."""
    ticks = []

    def check(line):
        with kept_on_failure(line.device, name):
            ticks.append(off_by(line))
            assert ticks[-1] <= 1

    line.on_tick = check
    driver = FirmwareDriver(line, hand_limits(), line.clock)
    driver.ready(clear=False)
    return driver.play(MOTION, Watch(lambda _sample: None, lambda: 0))


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("kind", KINDS)
def test_damaged_frames_cost_no_knot_and_few_resends(kind, seed):
    out, back = FrameDamage(kind, 0.03, seed), FrameDamage(kind, 0.03, seed + 100)
    line = VirtualLine(Recorded(core_controller()), out, back, baud_rate=115_200)
    played = run_over(line, f"{kind}-{seed}")
    assert played.final_state == "READY"
    # An answer that is lost costs a repeat like a frame that is.
    assert played.resends <= 2 * (out.lost + back.lost)
    assert kind == "duplicate" or out.lost > 0


def test_a_failures_bytes_can_be_played_again():
    line = VirtualLine(
        Recorded(core_controller()), bit_flips(1e-3, 1), bit_flips(1e-3, 2), baud_rate=115_200
    )
    run_over(line, "replayed")
    again = replayed(line.device.text(), core_controller())
    assert again.time_us == line.device.time_us
    assert again.follower.bad_frames == line.device.follower.bad_frames > 0
    np.testing.assert_array_equal(again.follower.command, line.device.follower.command)


def test_a_failing_test_leaves_its_bytes(tmp_path, monkeypatch):
    monkeypatch.setattr("tests.firmware.byte_log.FOLDER", tmp_path)
    device = Recorded(core_controller())
    device.receive(b"\1\2")
    with pytest.raises(AssertionError) as caught, kept_on_failure(device, "example"):
        raise AssertionError("as if")
    assert "byte_log" in caught.value.__notes__[0]
    assert (tmp_path / "example.log").read_text() == "0 0102\n0\n"


@pytest.mark.usefixtures("each_controller")
@pytest.mark.parametrize("joint", [0, 4, 8])
def test_a_quintic_that_overshoots_between_legal_knots_is_refused(joint):
    upper = hand_limits().upper_rad
    position = np.rint((swing().position[0]) * 1e6).astype(int)
    position[joint] = np.rint((upper[joint] - 0.01) * 1e6)
    bench = Bench(start_rad=position / 1e6)
    bench.device.tick()
    fast = np.zeros(12, int)
    fast[joint] = 800_000
    at = tuple(position.tolist())
    bench.ask(Arm())
    for each in (knot(0, at), moving(knot(1_000_000, at), fast)):
        assert isinstance(bench.ask(each), Ack)
    queued = bench.device.follower.queued
    answer = bench.ask(moving(knot(1_150_000, at), -fast))
    assert (answer.reason, answer.joint) == (Reason.POSITION_LIMIT, joint)
    assert (bench.device.follower.queued, bench.device.state) == (queued, State.ARMED)


def moving(message, velocity):
    return type(message)(**{**vars(message), "velocity_urad_s": tuple(velocity.tolist())})


@pytest.mark.parametrize("direction", DIRECTIONS)
def test_a_cut_after_every_11th_byte_of_a_session(direction):
    """Every byte, loud and silent, is for `make soak`."""
    cuts = Cuts()
    for number, cut in enumerate(range(0, bytes_of_a_session(direction) - 1, 11)):
        cuts.add(cut, direction, loud=number % 2 == 0)
    print(cuts)
    assert set(cuts.ends) <= {"LinkLost", "ControllerSilent"}
