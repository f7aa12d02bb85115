"""Motors' travel and speed between knots, against fine sampling and closed forms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fpcad.make.loads.motion import motor_commands, motor_motion
from fpcad.make.trajectory import Trajectory
from fpcad.model.transmission import hand_transmission
from tests.make.hands import CLAY
from tests.make.simple_hand import nod

A = hand_transmission(CLAY.motors.transmission, 4)


def wavy(preload: float) -> tuple[Trajectory, np.ndarray]:
    """Few knots with speeds that throw the joints far beyond them, and their preload [rad]."""
    random, still = np.random.default_rng(5), nod()
    shape = still.position_rad.shape
    position = random.uniform(-0.3, 0.3, shape)
    position[:, 3:6] = 0.2  # one finger rests
    moving = np.ones(12)
    moving[3:6] = 0.0
    ahead = preload * random.uniform(-1.0, 1.0, shape)
    moved = replace(
        still,
        position_rad=position,
        velocity_rad_s=random.uniform(-2.0, 2.0, shape) * moving,
        acceleration_rad_s2=random.uniform(-9.0, 9.0, shape) * moving,
        position_preload_rad=position + ahead,
    )
    return moved, ahead


@pytest.mark.parametrize("preload", [0.0, 0.1])
def test_extremes_are_those_of_a_fine_sampling(preload: float):
    trajectory, ahead = wavy(preload)
    motion = motor_motion(trajectory, A)
    time = np.linspace(0.0, 1.0, 40_001)
    lead = np.stack([np.interp(time, trajectory.time_s, ahead[:, k]) for k in range(12)], axis=1)
    angle = (trajectory.joints()(time) + lead) @ A.T
    speed = np.abs(np.diff(angle, axis=0)).max(axis=0) / (time[1] - time[0])
    np.testing.assert_allclose(motion.low_rad, angle.min(axis=0), atol=1e-6)
    np.testing.assert_allclose(motion.high_rad, angle.max(axis=0), atol=1e-6)
    np.testing.assert_allclose(motion.speed_rad_s, speed, rtol=2e-3, atol=1e-9)
    assert np.all(motion.high_rad >= angle.max(axis=0) - 1e-12)
    at_knots = ((trajectory.position_rad + ahead) @ A.T).max(axis=0)
    assert (motion.high_rad - at_knots).max() > 0.05  # knots alone would miss it


def test_commands_pass_through_the_preloaded_knots():
    trajectory, ahead = wavy(0.1)
    told = motor_commands(trajectory, A)(trajectory.time_s)
    np.testing.assert_allclose(told, (trajectory.position_rad + ahead) @ A.T, atol=1e-12)


def test_motors_alike_turn_as_the_differential_says():
    """Flexion by 1 rad alone turns m1 and m2 by rho, m3 by the idler's ratio."""
    still = nod()
    time = still.time_s
    position = np.zeros_like(still.position_rad)
    position[:, 0] = np.sin(np.pi * time)
    rate, bend = np.zeros_like(position), np.zeros_like(position)
    rate[:, 0], bend[:, 0] = np.pi * np.cos(np.pi * time), -(np.pi**2) * np.sin(np.pi * time)
    motion = motor_motion(
        replace(still, position_rad=position, velocity_rad_s=rate, acceleration_rad_s2=bend), A
    )
    routing = CLAY.motors.transmission
    rho = routing.input_pulley_radius_mm / routing.spool_radius_mm
    crossing = routing.idler_radius_mm / routing.spool_radius_mm
    assert motion.high_rad[:3] == pytest.approx([rho, rho, crossing], rel=1e-6)
    assert motion.speed_rad_s[:3] == pytest.approx(np.pi * np.array([rho, rho, crossing]), rel=1e-3)
    assert np.abs(motion.high_rad[3:]).max() == 0.0
