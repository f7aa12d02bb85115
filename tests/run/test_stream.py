"""Whole runs against the simulated controller, in time that passes only when it is waited for."""

import numpy as np
import pytest

from fpcad.run.driver import Watch
from fpcad.run.errors import (
    CommandRefused,
    ConfigurationMismatch,
    ControllerFault,
    ControllerHeld,
    ControllerReset,
    ControllerSilent,
    HeldByUser,
    JointMismatch,
    LinkLost,
    NotReady,
    ProtocolMismatch,
    StartTooFar,
    StoppedByUser,
)
from fpcad.run.firmware import FirmwareDriver
from fpcad.run.framing import FrameReader
from fpcad.run.knots import from_wire, to_wire
from fpcad.run.link import MAX_IN_FLIGHT
from fpcad.run.messages import State
from fpcad.run.quintic import evaluate
from fpcad.run.run_trajectory import follow
from fpcad.run.sim.controller import TICK_HZ
from tests.run.fixtures import NAMES, hand_limits, swing
from tests.run.virtual import (
    VirtualLine,
    bit_flips,
    controller,
    lost_bytes,
    lost_frames,
)

pytestmark = pytest.mark.usefixtures("each_controller")

KNOTS = swing(4.0, 101)
WIRE = from_wire(to_wire(KNOTS).messages)


class Faithful:
    """Checks in every tick that the command is what the knots say."""

    def __init__(self):
        self.ticks = 0

    def __call__(self, line):
        path = line.device.follower
        if line.device.state is State.RUNNING and path.rate == 1:
            self.ticks += 1
            wanted = evaluate(WIRE, np.array([path.path_us / 1e6])).position[0]
            np.testing.assert_allclose(path.command, wanted, atol=1e-6)


def run(line, knots=KNOTS, stops=lambda: 0, limits=None):
    driver = FirmwareDriver(line, limits or hand_limits(), line.clock)
    driver.ready(clear=False)
    samples = []
    played = driver.play(knots, Watch(samples.append, stops))
    return played, samples


def at(seconds, action):
    """Do something once, when the controller's clock says so."""
    done = []

    def check(line):
        if not done and line.device.time_us >= seconds * 1e6:
            done.append(True)
            action(line)

    return check


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


@pytest.mark.parametrize("seed", range(3))
def test_a_hopeless_line_ends_in_a_clean_stop(seed):
    line = VirtualLine()

    def break_line(line):
        line.to_device, line.to_host = bit_flips(0.05, seed), bit_flips(0.05, seed + 9)

    line.on_tick = at(1.5, break_line)
    with pytest.raises((LinkLost, ControllerHeld)):
        run(line)
    line.let_pass(1.0)
    assert line.device.state is State.HOLD and line.device.follower.rate == 0


def test_no_more_is_on_the_way_than_bounds_a_stop():
    line = VirtualLine(baud_rate=115_200)
    sizes = []
    line.on_tick = lambda line: sizes.append(len(line._to_device))
    run(line)
    assert max(sizes) <= MAX_IN_FLIGHT


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


@pytest.mark.parametrize(
    ("changes", "error", "words"),
    [
        ({"protocol": 3}, ProtocolMismatch, "version 3, this program 2"),
        ({"limits": hand_limits(configuration=b"x")}, ConfigurationMismatch, "transmission"),
        (
            {"limits": hand_limits(velocity_rad_s=np.full(12, 2.0))},
            ConfigurationMismatch,
            "thumb_mcp_flex: velocity limit 2 there",
        ),
    ],
)
def test_a_controller_that_does_not_fit_is_refused_without_motion(changes, error, words):
    line = VirtualLine(controller(**changes))
    with pytest.raises(error, match=words):
        run(line)
    assert motion_frames(line) == []


def test_another_number_of_joints_is_refused():
    ours = hand_limits()
    eleven = hand_limits(
        names=NAMES[:11],
        **{k: getattr(ours, k)[:11] for k in ("lower_rad", "upper_rad", "velocity_rad_s", "acceleration_rad_s2")},
    )  # fmt: skip
    line = VirtualLine(controller(limits=eleven, start_rad=np.zeros(11)))
    with pytest.raises(JointMismatch, match="11 joints, the trajectory 12"):
        run(line)
    assert motion_frames(line) == []


@pytest.mark.parametrize(
    ("to_host", "words"),
    [(lambda data: b"", "no answer within 5 s"), (bit_flips(1.0, 1), "no valid frame")],
)
def test_a_silent_controller_is_given_up(to_host, words):
    line = VirtualLine(to_host=to_host)
    with pytest.raises(ControllerSilent, match=words):
        run(line)
    assert 5.0 <= line.now_s < 5.1


def test_a_controller_that_boots_slowly_is_waited_for():
    late = VirtualLine()
    line = VirtualLine(to_device=lambda data: data if late.now_s > 0.7 else b"")
    line.on_tick = lambda line: setattr(late, "now_s", line.now_s)
    played, _ = run(line)
    assert played.final_state == "READY"


def test_an_unhomed_controller_is_not_run():
    line = VirtualLine(controller(homed=False))
    with pytest.raises(NotReady, match=r"IDLE.*not homed"):
        run(line)
    assert motion_frames(line) == []


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


def test_silence_of_the_host_ends_in_hold():
    line = VirtualLine()
    line.on_tick = at(2.0, lambda line: setattr(line, "to_device", lambda data: b""))
    with pytest.raises((LinkLost, ControllerHeld)):
        run(line)
    line.let_pass(1.0)
    assert line.device.state is State.HOLD and line.device.cause.name == "SILENCE"
    assert line.device.follower.rate == 0
    # It stopped half a second after the last word plus the time to slow down.
    assert line.device.follower.path_us < (2.0 - 0.24 + 0.5 + 0.2) * 1e6


def test_running_out_of_knots_ends_in_hold():
    line = VirtualLine()

    def knots_vanish(data):
        return b"" if any(f.kind == 0x11 for f in FrameReader().feed(data)) else data

    line.on_tick = at(1.0, lambda line: setattr(line, "to_device", knots_vanish))
    with pytest.raises((ControllerHeld, LinkLost)):
        run(line, swing(8.0, 201))
    line.let_pass(2.0)
    assert line.device.state is State.HOLD


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
    done = []

    def stall(sample):
        if sample.path_s > 1 and not done:
            done.append(True)
            line.let_pass(stall_s)

    driver = FirmwareDriver(line, hand_limits(), line.clock)
    driver.ready(clear=False)
    with pytest.raises(ControllerHeld, match="silence"):
        driver.play(KNOTS, Watch(stall, lambda: 0))
    line.let_pass(1.0)
    assert line.device.state is State.HOLD and line.device.follower.rate == 0


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


def test_stops_get_through_a_bad_line():
    line = VirtualLine(to_device=lost_frames(0.3, 4), to_host=lost_frames(0.3, 5))
    with pytest.raises(HeldByUser):
        run(line, stops=lambda: int(line.now_s > 2.5))


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


def motion_frames(line):
    frames = FrameReader().feed(b"".join(line.log))
    return [frame for frame in frames if 0x10 <= frame.kind < 0x40]
