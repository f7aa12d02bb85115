"""When one side falls silent, stalls, restarts or runs out of knots."""

import pytest

from fpcad.run.driver import Watch
from fpcad.run.errors import (
    CommandRefused,
    ControllerHeld,
    ControllerReset,
    LinkLost,
)
from fpcad.run.firmware import FirmwareDriver
from fpcad.run.messages import State
from fpcad.run.sim.controller import TICK_HZ
from tests.run.fixtures import hand_limits
from tests.run.streaming import KNOTS, Faithful, at, run, stall_once
from tests.run.virtual import (
    VirtualLine,
    controller,
)

pytestmark = pytest.mark.usefixtures("each_controller")


def test_silence_of_the_host_ends_in_hold():
    line = VirtualLine()
    line.on_tick = at(2.0, lambda line: setattr(line, "to_device", lambda data: b""))
    with pytest.raises(LinkLost):
        run(line)
    line.let_pass(1.0)
    assert line.device.state is State.HOLD and line.device.cause.name == "SILENCE"
    assert line.device.follower.rate == 0
    # It stopped half a second after the last word plus the time to slow down.
    assert line.device.follower.path_us < (2.0 - 0.24 + 0.5 + 0.2) * 1e6


def test_an_underrun_is_named():
    line = VirtualLine()
    driver = FirmwareDriver(line, hand_limits(), line.clock)
    driver.ready(clear=False)

    def starve(sample):
        if sample.state == "RUNNING":
            line.device.follower.keep(3)

    with pytest.raises((ControllerHeld, CommandRefused), match="underrun"):
        driver.play(KNOTS, Watch(starve, lambda: 0))
    line.let_pass(1.0)
    assert line.device.follower.rate == 0


def test_a_host_that_stalls_below_half_a_second_disturbs_nothing():
    line = VirtualLine(on_tick=(faithful := Faithful()))
    stalls = iter([0.05, 0.2, 0.45] * 2)

    def stall(sample):
        if sample.state == "RUNNING" and round(sample.device_s * 50) % 40 == 0:
            line.let_pass(next(stalls, 0.0))

    driver = FirmwareDriver(line, hand_limits(), line.clock)
    driver.ready(clear=False)
    driver.play(KNOTS, Watch(stall, lambda: 0))
    assert faithful.ticks == 4.0 * TICK_HZ - 1


@pytest.mark.parametrize("stall_s", [0.7, 2.0])
def test_a_longer_stall_ends_in_hold_and_is_not_resumed(stall_s):
    line = VirtualLine()
    driver = FirmwareDriver(line, hand_limits(), line.clock)
    driver.ready(clear=False)
    with pytest.raises(ControllerHeld, match="silence"):
        driver.play(KNOTS, Watch(stall_once(line, stall_s), lambda: 0))
    line.let_pass(1.0)
    assert line.device.state is State.HOLD and line.device.follower.rate == 0


class FrozenLine(VirtualLine):
    """The host is stopped while it waits for bytes, and finds what has come meanwhile."""

    frozen = False

    def read(self):
        if not self.frozen and self.device.follower.path_us > 1_000_000:
            self.frozen = True
            self.let_pass(0.7)
        return super().read()


def test_a_host_that_is_frozen_while_it_reads_blames_no_line():
    line = FrozenLine()
    with pytest.raises(ControllerHeld, match="silence"):
        run(line)
    assert line.device.state is State.HOLD


def test_a_restart_in_mid_run_is_never_resumed():
    line = VirtualLine()

    def restart(line):
        line.device = controller(boot_nonce=8)

    line.on_tick = at(2.0, restart)
    with pytest.raises(ControllerReset, match="not resumed"):
        run(line)
    assert line.device.state is State.READY
    assert line.now_s < 2.5


def test_a_dead_controller_is_noticed_within_half_a_second():
    line = VirtualLine()
    line.on_tick = at(2.0, lambda line: setattr(line, "connected", False))
    with pytest.raises(LinkLost, match="nothing heard"):
        run(line)
    assert line.now_s < 2.5
