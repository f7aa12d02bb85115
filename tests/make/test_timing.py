"""The time law: rest at both ends, limits held, and no slower than they ask for."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import BPoly

from fpcad.make.quintic import MotionLimits, pressure
from fpcad.make.refine import ContactCurve
from fpcad.make.timing import Ramp, TimeLaw, clock_cells, fastest_law

LENGTH, CELLS = 1.0, 50


def curve_of(joints, first, second, length=LENGTH, cells=CELLS) -> ContactCurve:
    """A curve through a joint's analytic values and derivatives."""
    turn = np.linspace(0.0, length, cells + 1)
    rows = np.stack([np.broadcast_to(f(turn), turn.shape) for f in (joints, first, second)], axis=1)
    return ContactCurve(length, length / cells, BPoly.from_derivatives(turn, rows[..., None]))


def law_of(curve: ContactCurve, speed=0.5, joint=1e3, acceleration=1e4) -> TimeLaw:
    limits = MotionLimits(speed, np.array([joint]), np.array([acceleration]))
    return fastest_law(curve, limits, np.ones(clock_cells(curve)))


def line(slope: float, length: float = LENGTH, cells: int = CELLS) -> ContactCurve:
    return curve_of(lambda s: slope * s, lambda s: slope, lambda s: 0.0, length, cells)


def wave() -> ContactCurve:
    return curve_of(
        lambda s: 0.3 * np.sin(10 * s), lambda s: 3 * np.cos(10 * s), lambda s: -30 * np.sin(10 * s)
    )


def test_ramp_is_smooth_and_reaches_the_end():
    ramp = Ramp(length=1.0, width=0.3)
    clock = np.linspace(0.0, ramp.end, 4001)
    turn, rate, bend = ramp.at(clock)
    assert turn[0] == rate[0] == bend[0] == rate[-1] == bend[-1] == 0.0
    assert turn[-1] == pytest.approx(1.0, abs=1e-15)
    np.testing.assert_allclose(np.gradient(turn, clock)[1:-1], rate[1:-1], atol=1e-5)
    np.testing.assert_allclose(np.gradient(rate, clock)[2:-2], bend[2:-2], atol=2e-2)


def test_ramp_may_fill_the_whole_motion():
    ramp = Ramp(length=0.2, width=0.2)
    turn, rate, _ = ramp.at(np.array([0.0, 0.2, 0.4]))
    np.testing.assert_allclose(turn, [0.0, 0.1, 0.2], atol=1e-15)
    np.testing.assert_allclose(rate, [0.0, 1.0, 0.0])


def test_motion_starts_and_ends_at_rest():
    law = law_of(wave(), acceleration=20.0)
    motion = law.at(np.linspace(0.0, law.ramp.end, 60))
    for end in (0, -1):
        assert motion.velocity[end] == motion.acceleration[end] == 0.0
    assert motion.time[0] == motion.turn[0] == 0.0
    assert motion.turn[-1] == pytest.approx(LENGTH, abs=1e-15)


def test_velocity_and_acceleration_are_those_of_the_position():
    law = law_of(wave(), acceleration=20.0)
    motion = law.at(np.linspace(0.0, law.ramp.end, 20001))
    velocity = np.gradient(motion.position[:, 0], motion.time)
    acceleration = np.gradient(motion.velocity[:, 0], motion.time)
    np.testing.assert_allclose(velocity[2:-2], motion.velocity[2:-2, 0], atol=1e-4)
    np.testing.assert_allclose(acceleration[2:-2], motion.acceleration[2:-2, 0], atol=0.05)


def test_free_motion_cruises_at_the_tools_speed():
    law = law_of(line(0.1))
    motion = law.at(np.linspace(0.0, law.ramp.end, 200))
    speed = np.diff(motion.turn) / np.diff(motion.time)
    assert speed.max() <= 0.5 * (1 + 1e-9)
    assert motion.time[-1] == pytest.approx((LENGTH + law.ramp.width) / 0.5, rel=1e-6)


def test_joint_speed_limits_the_tool():
    law = law_of(line(4.0), joint=1.0)
    motion = law.at(np.linspace(0.0, law.ramp.end, 2000))
    assert np.abs(motion.velocity).max() <= 1.0 + 1e-9
    assert motion.time[-1] < 1.05 * 4.0


def test_acceleration_limit_costs_hardly_more_than_a_bang_bang_law():
    law = law_of(line(1.0), speed=100.0, acceleration=4.0)
    motion = law.at(np.linspace(0.0, law.ramp.end, 2000))
    assert np.abs(motion.acceleration).max() <= 4.0 * 1.01
    fastest = 2 * np.sqrt(LENGTH / 4.0)
    assert fastest < motion.time[-1] < 1.08 * fastest


def test_limits_hold_on_a_winding_curve_and_one_is_nearly_always_active():
    law = law_of(wave(), joint=1.0, acceleration=8.0)
    motion = law.at(np.linspace(0.0, law.ramp.end, 4000))
    use = np.maximum(np.abs(motion.velocity[:, 0]), np.abs(motion.acceleration[:, 0]) / 8.0)
    use = np.maximum(use, np.gradient(motion.turn, motion.time) / 0.5)
    assert use.max() <= 1.03
    assert np.average(use > 0.93, weights=np.gradient(motion.time)) > 0.75


def test_slowed_cells_are_slow():
    curve, limits = line(1.0), MotionLimits(0.5, np.array([1e3]), np.array([1e3]))
    usable = np.ones(clock_cells(curve))
    usable[25] = 0.25
    law = fastest_law(curve, limits, usable)
    cell = np.linspace(25, 26, 9) / len(usable) * law.ramp.end
    assert np.all(law.squared_rate(cell) <= 0.25 * 0.5**2 * (1 + 1e-9))
    assert law.squared_rate(0.25 * law.ramp.end) == pytest.approx(0.5**2)


@pytest.mark.parametrize("length", [1e-3, 0.0175, 3.2])
def test_short_and_long_legs_have_a_law(length: float):
    law = law_of(line(1.0, length, cells=max(2, round(length / 0.0175))), acceleration=12.0)
    motion = law.at(np.linspace(0.0, law.ramp.end, 400))
    assert motion.turn[-1] == pytest.approx(length)
    assert np.abs(motion.acceleration).max() <= 12.0 * 1.05


def test_pressure_is_the_greatest_use_of_a_limit_in_each_segment():
    law = law_of(wave(), joint=1.0, acceleration=8.0)
    motion = law.at(np.linspace(0.0, law.ramp.end, 100))
    limits = MotionLimits(0.4, np.array([0.8]), np.array([6.0]))
    pressed, joints = pressure(motion, limits), motion.joints()
    for k, step in enumerate(np.diff(motion.time)):
        fine = motion.time[k] + step * np.linspace(0.0, 1.0, 400)
        speed, acceleration = np.abs(joints(fine, 1)).max(), np.abs(joints(fine, 2)).max()
        tool = (motion.turn[k + 1] - motion.turn[k]) / step
        exact = max((speed / 0.8) ** 2, acceleration / 6.0, (tool / 0.4) ** 2)
        assert exact * (1 - 1e-9) <= pressed[k] <= exact * 1.05 + 1e-3
