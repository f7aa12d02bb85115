"""Motors and joints do the same work."""

from __future__ import annotations

import numpy as np
import pytest

from fpcad.model.transmission import (
    finger_transmission,
    hand_transmission,
    joint_torques,
    motor_angles,
    motor_torques,
    single_axis_speed_limits,
    single_axis_torque_limits,
)
from fpcad.spec.hardware import Transmission

ROUTING = Transmission(
    spool_radius_mm=8.0,
    input_pulley_radius_mm=11.0,
    output_pulley_radius_mm=9.0,
    idler_radius_mm=3.0,
    ip_pulley_radius_mm=5.0,
)
A = finger_transmission(ROUTING)


def test_equal_radii_give_whole_numbers():
    same = Transmission(
        spool_radius_mm=10, input_pulley_radius_mm=10, output_pulley_radius_mm=10,
        idler_radius_mm=5, ip_pulley_radius_mm=10,
    )  # fmt: skip
    assert finger_transmission(same).tolist() == [[1, 1, 0], [1, -1, 0], [0.5, 0, 1]]


@pytest.mark.parametrize("seed", range(5))
def test_virtual_work_is_the_same_on_both_sides(seed):
    random = np.random.default_rng(seed)
    torques, joint_rates = random.normal(size=3), random.normal(size=3)
    work_of_motors = torques @ motor_angles(A, joint_rates)
    assert work_of_motors == pytest.approx(joint_torques(A, torques) @ joint_rates)


def test_torques_map_back():
    torques = np.random.default_rng(0).normal(size=(7, 3))
    assert np.allclose(motor_torques(A, joint_torques(A, torques)), torques)


def test_motors_alike_flex_and_opposed_abduct():
    assert joint_torques(A, np.array([1.0, 1.0, 0.0]))[1] == 0
    assert joint_torques(A, np.array([1.0, -1.0, 0.0]))[0] == 0


def test_fingers_do_not_share_motors():
    hand = hand_transmission(ROUTING, 4)
    assert hand.shape == (12, 12)
    assert np.array_equal(hand[3:6, 3:6], A)
    assert not hand[:3, 3:].any()


@pytest.mark.parametrize("joint", range(3))
def test_a_joint_alone_at_its_limit_saturates_a_motor(joint):
    alone = np.eye(3)[joint]
    torque = single_axis_torque_limits(A, 0.9)[joint]
    assert np.abs(motor_torques(A, alone * torque)).max() == pytest.approx(0.9)
    speed = single_axis_speed_limits(A, 5.0)[joint]
    assert np.abs(motor_angles(A, alone * speed)).max() == pytest.approx(5.0)
