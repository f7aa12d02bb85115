"""Grip preload: its bounds, what it does to the tendons, and what it does not trip."""

import numpy as np
import pytest

from fpcad.run.driver import Watch
from fpcad.run.errors import CommandRefused, ControllerFault
from fpcad.run.firmware import FirmwareDriver
from fpcad.run.firmware_setup import TRACKING_LIMIT_RAD
from fpcad.run.limits import from_counts
from fpcad.run.messages import PRELOAD_URAD, Ack, Arm, Estop, Health, Hold, Reason, State
from fpcad.run.quintic import Knots
from tests.run.fixtures import hand_limits, swing
from tests.run.test_states import Bench, knot
from tests.run.virtual import VirtualLine, controller

pytestmark = pytest.mark.usefixtures("each_controller")

GRIP = np.tile([0.12, 0.0, 0.2], 4)
"""More than the tracking limit in the IP joints."""
COUNT = PRELOAD_URAD * 1e-6


def counts(preload_rad):
    return np.rint(np.broadcast_to(preload_rad, 12) / COUNT).astype(int).tolist()


def closing(seconds=0.5, grip=GRIP):
    """Stands still while the preload rises."""
    motion = swing()
    return standing(np.array([0.0, seconds]), np.stack([np.zeros(12), grip]), motion.position[0])


def standing(time_s, preload, position):
    still = np.zeros((len(time_s), 12))
    return Knots(time_s, np.tile(position, (len(time_s), 1)), still, still, preload)


def gripping(motion=None):
    """The swing under a constant grip."""
    m = motion or swing()
    return Knots(
        m.time_s, m.position, m.velocity, m.acceleration, np.tile(GRIP, (len(m.time_s), 1))
    )


def followed(line, *motions, clear=False):
    driver = FirmwareDriver(line, hand_limits(), line.clock)
    driver.ready(clear=clear)
    samples = []
    for motion in motions:
        assert driver.play(motion, Watch(samples.append, lambda: 0)).final_state == "READY"
    return samples


def free_fingers(line):
    """The simulated fingers meet no tool, so they go where the goals are."""
    return line.device.plant.position - line.device.follower.command


def test_a_loaded_grip_closes_holds_and_moves_without_tripping_the_tracking_limit():
    line = VirtualLine(controller())
    samples = followed(line, closing(), gripping())
    seen = max(np.abs(s.position_rad - s.command_rad).max() for s in samples)
    assert seen > TRACKING_LIMIT_RAD
    np.testing.assert_allclose(free_fingers(line), GRIP, atol=5e-3)
    np.testing.assert_allclose(line.device.follower.command, swing().position[-1], atol=1e-6)


def test_preload_rises_straight_between_knots():
    line = VirtualLine(controller())
    seen = []

    def note(line):
        follower = line.device.follower
        if line.device.state is State.RUNNING and follower.rate > 0:
            seen.append((follower.path_us / 1e6, np.array(line.device.follower.preload)))

    line.on_tick = note
    followed(line, closing())
    times, preloads = np.array([t for t, _ in seen]), np.array([p for _, p in seen])
    np.testing.assert_allclose(preloads, times[:, None] / 0.5 * GRIP, atol=2 * COUNT)


def test_what_the_grip_does_not_explain_is_a_fault():
    line = VirtualLine(controller())
    driver = FirmwareDriver(line, hand_limits(), line.clock)
    driver.ready(clear=False)
    line.device.plant.jam(2)
    with pytest.raises(ControllerFault, match="does not follow"):
        driver.play(swing(2.0, 61, amplitude=0.3), Watch(lambda _s: None, lambda: 0))


def test_a_grip_that_jams_on_its_tool_is_no_fault():
    line = VirtualLine(controller())
    driver = FirmwareDriver(line, hand_limits(), line.clock)
    driver.ready(clear=False)
    for motor in range(12):
        line.device.plant.jam(motor)  # the tool lets nothing close any further
    played = driver.play(closing(), Watch(lambda _s: None, lambda: 0))
    assert played.final_state == "READY"


def test_a_motor_that_preload_holds_where_it_is_has_no_stuck_encoder():
    line = VirtualLine(controller())
    driver = FirmwareDriver(line, hand_limits(), line.clock)
    driver.ready(clear=False)
    path = swing(4.0, 121, amplitude=0.25)
    against = path.position[0] - path.position
    held = Knots(path.time_s, path.position, path.velocity, path.acceleration, against)
    for motor in range(12):
        line.device.plant.jam(motor)
    assert driver.play(held, Watch(lambda _s: None, lambda: 0)).final_state == "READY"


BEYOND = [
    ([], 0, [0] * 11 + [200], 11),
    ([0], 100_000, [0, counts(0.15)[1], *[0] * 10], 1),
    ([0, 0.4, 0.49], 2_000_000, counts([0.49] * 5 + [0.52] + [0.49] * 6), 5),
    ([0, -0.4, -0.49], 2_000_000, counts([-0.52] + [-0.49] * 11), 0),
]
"""Preloads that knots have had, half a second apart; then when, which one is too much, and where."""
BEYOND_IDS = ["from the first knot", "too fast", "too much", "too much the other way"]


@pytest.mark.parametrize(("before", "t_us", "preload", "joint"), BEYOND, ids=BEYOND_IDS)
def test_a_preload_beyond_its_bounds_is_refused_and_changes_nothing(before, t_us, preload, joint):
    bench = Bench()
    bench.device.tick()
    bench.ask(Arm())
    for number, rad in enumerate(before):
        assert isinstance(bench.ask(knot(500_000 * number, preload=counts(rad))), Ack)
    queued = bench.device.follower.queued
    answer = bench.ask(knot(t_us, preload=preload))
    assert (answer.reason, answer.joint) == (Reason.PRELOAD_LIMIT, joint)
    assert bench.device.follower.queued == queued


def test_the_driver_names_a_preload_that_is_refused():
    line = VirtualLine(controller())
    with pytest.raises(CommandRefused, match="preload limit"):
        followed(line, gripping())


def test_a_held_grip_may_go_on_and_a_cleared_one_rests_where_it_is():
    line = VirtualLine(controller())
    followed(line, closing(), gripping())
    followed(line, gripping())  # READY keeps the grip
    driver = FirmwareDriver(line, hand_limits(), line.clock)
    driver._link.send_now(Hold())
    line.let_pass(0.3)
    np.testing.assert_allclose(line.device.follower.preload, GRIP, atol=COUNT)
    assert driver.ready(clear=True).state == "READY"
    line.let_pass(0.3)
    np.testing.assert_allclose(line.device.follower.preload, 0)
    np.testing.assert_allclose(free_fingers(line), 0, atol=5e-3)


def test_health_tells_the_preload():
    line = VirtualLine(controller())
    driver = FirmwareDriver(line, hand_limits(), line.clock)
    driver.ready(clear=False)
    driver.play(closing(), Watch(lambda _s: None, lambda: 0))
    heard = []
    for _ in range(60):
        heard += [m for m in driver._link.poll() if isinstance(m, Health)]
    np.testing.assert_allclose(
        from_counts(heard[-1].preload_20urad) * PRELOAD_URAD, GRIP, atol=COUNT
    )


def test_an_emergency_stop_ends_the_preload():
    bench = Bench()
    bench.device.tick()
    for message in (Arm(), knot(0), knot(500_000, preload=counts(0.3))):
        bench.ask(message)
    bench.ask(Estop())
    np.testing.assert_allclose(bench.device.follower.preload, 0)
