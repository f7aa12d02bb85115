import numpy as np
import pytest

from fpcad.run.knots import from_wire, to_wire
from fpcad.run.quintic import evaluate
from fpcad.run.sim.controller import TICK_HZ
from fpcad.run.sim.follower import PathFollower
from tests.run.fixtures import hand_limits, swing

DT = 1 / TICK_HZ


def limits_of_the_motion():
    """Limits that the swing just keeps, so that braking has nothing to spare."""
    motion = evaluate(swing(), np.linspace(0, 2, 2001))
    return hand_limits(
        velocity_rad_s=np.abs(motion.velocity).max(axis=0) * 1.001,
        acceleration_rad_s2=np.full(12, np.abs(motion.acceleration).max() * 1.001),
    )


def follower(limits, knots=61, ended=True):
    device = PathFollower(limits, 100, swing().position[0])
    for knot in to_wire(swing()).messages[:knots]:
        assert device.offer(knot, swing().position[0]) is None
    if ended:
        assert device.end(knots) is None
    device.start()
    return device


def commands(device, ticks):
    rows = []
    for _ in range(ticks):
        device.step(DT)
        rows.append(device.command)
    return np.array(rows)


def test_commands_lie_on_the_quintics():
    device = follower(hand_limits())
    rows = commands(device, 600)
    t = np.minimum(np.arange(1, 601) * DT, 2.0)
    wire = from_wire(to_wire(swing()).messages)
    np.testing.assert_allclose(rows, evaluate(wire, t).position, atol=1e-12)
    assert device.arrived and device.rate == 0


@pytest.mark.parametrize("stop_at", range(5, 500, 90))
@pytest.mark.parametrize("motion_limits", [hand_limits, limits_of_the_motion])
def test_stopping_keeps_to_the_path_and_to_the_limits(stop_at, motion_limits):
    limits = motion_limits()
    device = follower(limits)
    before = commands(device, stop_at)
    device.stop()
    after = commands(device, 250)
    assert device.rate == 0
    rows = np.vstack([swing().position[:1], before, after])
    acceleration = np.diff(rows, 2, axis=0) / DT**2
    # A difference over two ticks sees the jump of acceleration at the stop only in part.
    assert (np.abs(acceleration) <= limits.acceleration_rad_s2 * 1.05).all()
    path = evaluate(from_wire(to_wire(swing()).messages), np.linspace(0, 2, 4001)).position
    off_path = np.abs(after[:, None] - path[None]).max(axis=2).min(axis=1)
    assert off_path.max() < 2e-4


def test_stopping_is_quick_where_the_joints_can():
    device = follower(hand_limits())
    commands(device, 250)
    device.stop()
    commands(device, int(0.1 / DT))
    assert device.rate == 0


def test_a_path_that_is_used_up_while_braking_is_left_straight_and_slowing():
    limits = limits_of_the_motion()
    device = follower(limits, knots=20, ended=False)
    end = device.queued_us / 1e6
    commands(device, int(end / DT) - 1)
    device.stop()
    rows = commands(device, 250)
    assert device.rate == 0
    assert (np.abs(np.diff(rows, 2, axis=0)) / DT**2 <= limits.acceleration_rad_s2 * 1.05).all()
