"""Runs over a line that damages what passes: complete, or a lost link and a hand that holds."""

import re

import pytest

from fpcad.run.driver import Watch
from fpcad.run.errors import (
    ControllerHeld,
    HeldByUser,
    LinkLost,
)
from fpcad.run.firmware import FirmwareDriver
from fpcad.run.framing import FrameReader
from fpcad.run.line_record import LineRecord
from fpcad.run.messages import Cause, State
from fpcad.run.sim.controller import TICK_HZ
from tests.run.fixtures import hand_limits, swing
from tests.run.streaming import KNOTS, Faithful, at, run, stall_once
from tests.run.virtual import (
    VirtualLine,
    bit_flips,
    lost_bytes,
    lost_frames,
)

pytestmark = pytest.mark.usefixtures("each_controller")


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(
    "damage",
    [
        lambda seed: bit_flips(1e-4, seed),
        lambda seed: bit_flips(1e-3, seed),
        lambda seed: lost_bytes(1e-3, seed),
        lambda seed: lost_frames(0.03, seed),
    ],
    ids=["flips 1e-4", "flips 1e-3", "lost bytes 1e-3", "lost frames 3 %"],
)
def test_a_bad_line_changes_no_knot(damage, seed):
    line = VirtualLine(
        to_device=damage(seed),
        to_host=damage(seed + 100),
        baud_rate=115_200,
        on_tick=(faithful := Faithful()),
    )
    played, _ = run(line)
    assert played.final_state == "READY"
    assert faithful.ticks == 4.0 * TICK_HZ - 1


def told_end(line):
    """The state in which a run ended, or what is told of a lost link."""
    try:
        return run(line)[0].final_state
    except LinkLost as lost:
        return str(lost)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("rate", [3e-3, 1e-2])
def test_a_line_too_bad_for_a_run_is_lost_in_order(rate, seed):
    line = VirtualLine(
        to_device=bit_flips(rate, seed),
        to_host=bit_flips(rate, seed + 9999),
        baud_rate=115_200,
        on_tick=(faithful := Faithful()),
    )
    end = told_end(line)
    if end == "READY":
        assert rate < 1e-2 and faithful.ticks == 4.0 * TICK_HZ - 1
    else:  # what the line did is told
        assert re.search(r"\(\d+ frames sent again, [1-9]\d* unreadable\)", end)
    line.let_pass(1.5)
    assert line.device.state in (State.HOLD, State.READY) and line.device.follower.rate == 0


def test_a_controller_that_the_line_starves_is_the_lines_fault():
    line = VirtualLine()

    def knots_vanish(data):
        return b"" if any(f.kind == 0x11 for f in FrameReader().feed(data)) else data

    line.on_tick = at(1.0, lambda line: setattr(line, "to_device", knots_vanish))
    with pytest.raises(LinkLost, match="frames sent again"):
        run(line, swing(8.0, 201))
    line.let_pass(2.0)
    assert line.device.state is State.HOLD and line.device.follower.rate == 0


def test_a_host_that_stalls_on_a_noisy_line_is_the_hosts_fault():
    line = VirtualLine(to_device=bit_flips(1e-3, 3), to_host=bit_flips(1e-3, 4))
    driver = FirmwareDriver(line, hand_limits(), line.clock)
    driver.ready(clear=False)
    with pytest.raises(ControllerHeld, match="silence"):
        driver.play(KNOTS, Watch(stall_once(line, 0.7), lambda: 0))


@pytest.mark.parametrize(
    ("cause", "stalled_s", "resent_s", "lines"),
    [
        (Cause.SILENCE, None, None, True),
        (Cause.SILENCE, 9.0, 9.5, False),
        (Cause.SILENCE, 2.0, None, True),
        (Cause.UNDERRUN, None, 9.0, True),
        (Cause.UNDERRUN, None, 2.0, False),
        (Cause.UNDERRUN, 9.0, 9.5, False),
        (Cause.HOST, None, 9.9, False),
    ],
)
def test_who_is_to_blame_for_a_hold(cause, stalled_s, resent_s, lines):
    record, now_s = LineRecord(), 0.0
    while now_s < 10.0:
        record.look(now_s)
        step = 0.5 if stalled_s is not None and abs(now_s + 0.5 - stalled_s) < 1e-6 else 0.1
        if resent_s is not None and abs(now_s - resent_s) < 1e-6:
            record.resent(now_s)
        now_s = round(now_s + step, 6)
    assert record.is_to_blame(cause, now_s) is lines


def test_a_controllers_count_of_bad_frames_begins_with_the_session_and_wraps():
    record = LineRecord(unread_here=2)
    for count in (65_530, 65_535, 4):
        record.hear_unread(count)
    assert record.unread == 2 + 10


@pytest.mark.parametrize("seed", range(3))
def test_a_hopeless_line_ends_in_a_clean_stop(seed):
    line = VirtualLine()

    def break_line(line):
        line.to_device, line.to_host = bit_flips(0.05, seed), bit_flips(0.05, seed + 9)

    line.on_tick = at(1.5, break_line)
    with pytest.raises(LinkLost, match="unreadable"):
        run(line)
    line.let_pass(1.0)
    assert line.device.state is State.HOLD and line.device.follower.rate == 0


def test_repeats_stay_below_twice_the_losses():
    lost = []
    keep = lost_frames(0.05, 1)

    def lossy(data):
        out = keep(data)
        lost.append(max(data.count(0) - out.count(0), 0))
        return out

    line = VirtualLine(to_device=lossy, baud_rate=115_200)
    played, _ = run(line)
    assert 0 < played.resends <= 2 * sum(lost)


def test_stops_get_through_a_bad_line():
    line = VirtualLine(to_device=lost_frames(0.3, 4), to_host=lost_frames(0.3, 5))
    with pytest.raises(HeldByUser):
        run(line, stops=lambda: int(line.now_s > 2.5))
