"""The MJCF drives the hand as its motors would."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from ruamel.yaml import YAML

from fpcad.make.preload.stiffness import hand_stiffness
from fpcad.make.transmission_file import transmission_yaml
from fpcad.spec.catalogue import motor
from tests.make.description.engine import mujoco
from tests.make.hands import CENTRE, CLAY, geometry_of
from tests.make.simple_hand import JOINTS, TRAJECTORIES

SECOND = 500
"""Steps of 2 ms."""


@pytest.fixture
def hand(described):
    return mujoco.MjModel.from_xml_path(str(described[CENTRE] / "mjcf" / "clay.xml"))


@pytest.fixture
def scene(described):
    return mujoco.MjModel.from_xml_path(str(described[CENTRE] / "mjcf" / "scene.xml"))


def settle(model: Any, command: np.ndarray, steps: int = SECOND) -> Any:
    """The hand after a while at a command of its motors, from straight fingers."""
    data = mujoco.MjData(model)
    data.ctrl[:] = command
    for _ in range(steps):
        mujoco.mj_step(model, data)
    return data


def test_motors_pull_joints_by_the_rows_of_the_transmission_file(hand):
    file = YAML(typ="safe").load(transmission_yaml(CLAY, geometry_of(CENTRE)))
    data = mujoco.MjData(hand)
    data.qpos[:] = np.random.default_rng(1).normal(size=hand.nq)
    mujoco.mj_forward(hand, data)
    joints = [data.qpos[hand.joint(name).qposadr[0]] for name in file["joints"]]
    motors = [data.actuator_length[hand.actuator(name).id] for name in file["motors"]]
    assert np.allclose(np.array(file["matrix"]) @ joints, motors, rtol=0, atol=1e-15)


def test_motors_give_no_more_than_their_continuous_torque(hand):
    row = motor(CLAY.motors.type)
    data = mujoco.MjData(hand)
    data.ctrl[:] = 10.0
    mujoco.mj_forward(hand, data)
    assert data.actuator_force == pytest.approx(row.continuous_torque_nm)


def test_motors_are_as_stiff_as_the_grip_takes_servo_and_tendon_to_be(hand):
    data = mujoco.MjData(hand)
    data.ctrl[:] = 0.01
    mujoco.mj_forward(hand, data)
    in_series = 1e-3 * hand_stiffness(CLAY).motor_nmm_rad
    assert data.actuator_force == pytest.approx(0.01 * in_series)


def test_every_pose_is_a_keyframe_of_hand_and_scene(hand, scene):
    for model in (hand, scene):
        assert [model.key(i).name for i in range(model.nkey)] == list(TRAJECTORIES)
    tool = scene.joint("tool").qposadr[0]
    for pose, trajectory in TRAJECTORIES.items():
        key = scene.key(pose)
        joints = key.qpos[[scene.joint(name).qposadr[0] for name in JOINTS]]
        assert np.array_equal(joints, trajectory.position_rad[0])
        assert np.array_equal(key.qpos[tool : tool + 7], trajectory.tool.pose_palm[0])
        assert np.array_equal(hand.key(pose).ctrl, key.ctrl)


def test_a_keyframes_command_holds_its_posture_against_gravity(hand):
    data = settle(hand, hand.key("nod").ctrl)
    assert np.abs(data.qpos - hand.key("nod").qpos).max() < np.radians(0.1)
    assert np.abs(data.qvel).max() < 1e-6


def test_a_keyframes_command_holds_the_preload_where_there_is_one(hand):
    data = settle(hand, hand.key("tight").ctrl)
    offset = data.qpos - hand.key("tight").qpos
    assert offset == pytest.approx(0.05, abs=np.radians(0.1))


def test_preload_is_within_the_range_of_commands(hand):
    low, high = hand.actuator_ctrlrange.T
    for i in range(hand.nkey):
        assert np.all((low < hand.key(i).ctrl) & (hand.key(i).ctrl < high))


def test_straight_fingers_touch_nothing_by_construction(hand):
    data = mujoco.MjData(hand)
    mujoco.mj_forward(hand, data)
    assert data.ncon == 0


def test_fingers_stop_each_other(hand):
    """The middle finger, abducted towards the index, meets it instead of passing through."""
    data = mujoco.MjData(hand)
    command = np.zeros(hand.nu)
    for finger, abduction in (("index", -0.4), ("middle", 0.4)):
        command[hand.actuator(f"{finger}_m1").id] = abduction
        command[hand.actuator(f"{finger}_m2").id] = -abduction
    data = settle(hand, command)
    pairs = {
        frozenset(hand.geom(int(g)).name for g in contact.geom)
        for contact in data.contact[: data.ncon]
    }
    assert frozenset(("index_distal", "middle_distal")) in pairs
    assert data.joint("middle_mcp_abd").qpos[0] < 0.35


def test_the_tool_is_free_and_as_heavy_as_the_spec_says(scene):
    tool = scene.body("tool")
    assert tool.mass[0] == pytest.approx(CLAY.grip.tool_mass_g * 1e-3)
    data = mujoco.MjData(scene)
    mujoco.mj_resetDataKeyframe(scene, data, 0)
    for _ in range(50):
        mujoco.mj_step(scene, data)
    assert data.body("tool").xpos[2] == pytest.approx(-0.08 - 9.81 / 2 * 0.1**2, rel=0.01)


def test_the_hand_can_be_attached_to_another_model(described):
    """Two hands in one world, each under its own prefix."""
    world = mujoco.MjSpec()
    for side, x in (("left/", -0.2), ("right/", 0.2)):
        hand = mujoco.MjSpec.from_file(str(described[CENTRE] / "mjcf" / "clay.xml"))
        world.worldbody.add_frame(pos=[x, 0, 0]).attach_body(hand.body("palm"), side, "")
    model = world.compile()
    assert model.nu == 24 and model.njnt == 24
    assert model.body("left/index_distal").id > 0
