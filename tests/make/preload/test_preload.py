"""Grip preload of clay's first hand: forces, stiffness and commands, against other ways to them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fpcad.errors import MakeError
from fpcad.make.grip import ContactLink, Grip
from fpcad.make.preload.margins import cone_share, load_until_slip, slip_margin, with_errors
from fpcad.make.preload.plan import Preload, gravity_load, grip_preload
from fpcad.make.preload.stiffness import (
    HandStiffness,
    contact_stiffness,
    grasp_stiffness,
    hand_stiffness,
)
from fpcad.make.preload.touch import Touch, joint_axes, touch
from fpcad.model.geometry import hand_geometry, link_poses
from fpcad.model.hand import hand_template
from fpcad.model.pose import HAND_SIZE
from fpcad.spec.schema import Spec

Array = NDArray[np.float64]
POSES = ("carve", "poke", "press")


@dataclass(frozen=True)
class Held:
    """A pose of the first hand as a path of one state."""

    spec: Spec
    pose: str
    grip: Grip
    joints: Array  # (1, n_u)
    angles: Array  # (1,)
    state: Array
    design: Array

    @property
    def touch(self) -> Touch:
        return touch(self.grip, self.joints, self.angles)

    @property
    def stiffness(self) -> HandStiffness:
        return hand_stiffness(self.spec)

    def preload(self, **settings) -> Preload:
        grip = self.spec.grip.model_copy(update=settings)
        spec = self.spec.model_copy(update={"grip": grip})
        return grip_preload(spec, self.grip, self.joints, self.angles)


@pytest.fixture(scope="module", params=POSES)
def held(request, bench, first_hand) -> Held:
    spec, pose, y = bench.spec, request.param, first_hand.states[request.param]
    contacts = tuple(ContactLink(c.finger, c.link) for c in spec.poses[pose].contacts)
    geometry = hand_geometry(bench.template, first_hand.design)
    grip = Grip(geometry, spec.tool, spec.poses[pose].turning, y[:HAND_SIZE], contacts)
    joints = y[None, HAND_SIZE : HAND_SIZE + 12]
    return Held(spec, pose, grip, joints, np.zeros(1), y, first_hand.design)


def test_contacts_push_and_turn_as_the_model_says(held: Held, bench):
    """Wrenches and torques of the model's normal forces, which are in O, from ours in H."""
    y = held.state
    wrench, torque, _ = bench.kernels[held.pose].statics(
        held.design, y[:HAND_SIZE], 0.0, y[HAND_SIZE:]
    )
    normals, presses = wrench[:, ::3], torque[:, ::3]
    to_tool = held.grip.tool_poses(held.angles)[1].inv()
    ours = held.touch.grasp_map[0][:, ::3]
    np.testing.assert_allclose(to_tool.apply(ours[:3].T), normals[:3].T, atol=1e-6)
    centre = [(held.spec.tool.back_mm + held.spec.tool.tip_mm) / 2, 0.0, 0.0]
    about_centre = normals[3:].T - np.cross(centre, normals[:3].T)
    np.testing.assert_allclose(to_tool.apply(ours[3:].T), about_centre, atol=1e-5)
    np.testing.assert_allclose(held.touch.torque_map[0][:, ::3], presses, atol=1e-4)


def test_forces_carry_the_tool_inside_half_the_cone(held: Held):
    preload = held.preload()
    forces = preload.forces_n.reshape(1, -1)
    load = gravity_load(held.spec, 1)
    assert np.abs(held.touch.grasp_map[0] @ forces[0] + load[0]).max() < 1e-9
    assert preload.forces_n[..., 0].min() > held.spec.grip.min_normal_force_n - 0.01
    assert cone_share(forces, held.spec.statics.friction).max() < 0.51
    torque = held.stiffness.motor_torque(held.touch.torque_map[0] @ forces[0])
    assert np.abs(torque).max() < 900.0


def test_commands_lie_ahead_by_torque_over_stiffness(held: Held):
    rigid = held.preload(skin_stiffness_n_mm=1e9)
    torque = held.touch.torque_map[0] @ rigid.forces_n.ravel()
    ahead = held.stiffness.joint_nmm_rad @ (rigid.position_rad - held.joints)[0]
    np.testing.assert_allclose(ahead, torque, atol=1e-3)


def test_a_finger_without_contact_is_told_where_it_is(held: Held):
    fingers = held.grip.geometry.fingers
    idle = [f for f in fingers if f not in {c.finger for c in held.grip.contacts}]
    offset = (held.preload().position_rad - held.joints).reshape(-1, 3)
    assert all(np.abs(offset[fingers.index(f)]).max() < 1e-12 for f in idle)


def test_soft_skin_asks_for_sinking_in(held: Held):
    """The difference that skin makes moves each contact along its normal by force over stiffness."""
    hard, soft = held.preload(skin_stiffness_n_mm=1e9), held.preload(skin_stiffness_n_mm=30.0)
    moved = np.einsum(
        "nij,j->ni", held.touch.jacobians_mm[0], (soft.position_rad - hard.position_rad)[0]
    )
    sunk = np.einsum("ni,nia->na", moved, held.touch.axes[0])
    np.testing.assert_allclose(sunk[:, 0], soft.forces_n[0, :, 0] / 30.0, rtol=0.1)


@pytest.mark.parametrize("held", ["carve", "press"], indirect=True)  # no straight finger
def test_grip_stiffness_is_the_energys_second_derivative(held: Held):
    """Fingers that stick to a tool which is moved a little, solved posture by posture."""
    forces = held.preload(skin_stiffness_n_mm=1e9).forces_n
    hard = HandStiffness(held.stiffness.A, held.stiffness.motor_nmm_rad, 1e12)
    stiffness = grasp_stiffness(held.touch, hard, forces.reshape(1, -1))[0]
    energy = _Energy(held, forces[0])
    scale = np.repeat([1e-3, 3e-5], 3)
    for a, b in ((0, 0), (1, 2), (3, 3), (4, 4), (5, 5), (3, 5), (1, 4)):
        da, db = np.eye(6)[a] * scale, np.eye(6)[b] * scale
        second = energy(da + db) - energy(da - db) - energy(db - da) + energy(-da - db)
        second /= 4 * scale[a] * scale[b]
        size = np.sqrt(abs(stiffness[a, a] * stiffness[b, b]))
        assert abs(second - stiffness[a, b]) < 2e-3 * size


class _Energy:
    """Energy [N mm] of the fingers' springs and of gravity's work, as the tool moves."""

    def __init__(self, held: Held, forces: Array) -> None:
        self._held, self._K = held, held.stiffness.joint_nmm_rad
        at = held.touch
        self._points, self._centre = at.points_mm[0], at.centre_mm[0]
        self._links = [self._in_link(i, self._points[i]) for i in range(len(self._points))]
        torque = at.torque_map[0] @ forces.ravel()
        self._command = held.joints[0] + np.linalg.solve(self._K, torque)
        self._weight = gravity_load(held.spec, 1)[0]

    def __call__(self, moved: Array) -> float:
        turn = Rotation.from_rotvec(moved[3:])
        wanted = self._centre + turn.apply(self._points - self._centre) + moved[:3]
        joints = self._held.joints[0].copy()
        for index, contact in enumerate(self._held.grip.contacts):
            first = 3 * self._held.grip.geometry.fingers.index(contact.finger)
            own = slice(first, first + 3)
            for _ in range(8):
                at = self._place(index, joints)
                axes = joint_axes(self._held.grip.geometry, contact.finger, joints[None])
                J = np.stack([np.cross(axis[0], at - p[0]) for axis, p in axes], axis=1)
                joints[own] += np.linalg.solve(J, wanted[index] - at)
        ahead = self._command - joints
        return float(ahead @ self._K @ ahead / 2 - self._weight[:3] @ moved[:3])

    def _pose(self, index: int, joints: Array) -> Array:
        contact = self._held.grip.contacts[index]
        poses = link_poses(
            hand_template(self._held.spec.hand), self._held.design, joints.reshape(4, 3)
        )
        return poses[contact.finger][contact.link]

    def _in_link(self, index: int, point: Array) -> Array:
        pose = self._pose(index, self._held.joints[0])
        return pose[:3, :3].T @ (point - pose[:3, 3])

    def _place(self, index: int, joints: Array) -> Array:
        pose = self._pose(index, joints)
        return pose[:3, :3] @ self._links[index] + pose[:3, 3]


def test_the_grip_is_stable(held: Held):
    stiffness = grasp_stiffness(held.touch, held.stiffness, held.preload().forces_n.reshape(1, -1))
    assert np.linalg.eigvalsh(stiffness[0])[0] > 0.0
    assert held.preload().margins.least_stiffness_n_mm > 0.0


def test_wrong_forces_are_shared_out_in_balance(held: Held):
    forces = held.preload().forces_n.reshape(1, -1)
    load = gravity_load(held.spec, 1)[0]
    wrong = with_errors(held.touch, held.stiffness, forces)
    assert np.abs(wrong[:, 0] @ held.touch.grasp_map[0].T + load).max() < 1e-6
    margins = held.preload().margins
    assert margins.slip_margin_with_error_n < margins.slip_margin_n


def test_a_finger_that_yields_twice_as_much_is_half_as_stiff(held: Held):
    twice = HandStiffness(held.stiffness.A, 2 * held.stiffness.motor_nmm_rad, 1e12)
    once = HandStiffness(held.stiffness.A, held.stiffness.motor_nmm_rad, 1e12)
    soft, hard = contact_stiffness(held.touch, once), contact_stiffness(held.touch, twice)
    np.testing.assert_allclose(hard, 2 * soft, rtol=1e-6, atol=1e-6 * np.abs(hard).max())


def test_motors_that_are_too_weak_are_told_of(held: Held):
    with pytest.raises(MakeError, match="within the motors' torque"):
        held.preload(min_normal_force_n=500.0, stiffness_share=0.0)


@pytest.mark.parametrize(
    ("change", "factor"),
    [
        ((0.0, 1.0, 0.0), 0.8),  # tangential grows to mu f_n
        ((-1.0, 0.0, 0.0), 1.0),  # normal vanishes
        ((1.0, 0.8, 0.0), np.inf),  # along the cone's edge
        ((2.0, 0.0, 0.0), np.inf),
        ((-1.0, 0.8, 0.0), 0.5),
    ],
)
def test_load_until_slip_in_closed_form(change, factor):
    force = np.array([[1.0, 0.0, 0.0]])
    assert load_until_slip(force, np.array([change]), 0.8)[0] == pytest.approx(factor)


def test_slip_margin_counts_what_is_left_of_friction():
    assert slip_margin(np.array([2.0, 0.3, 0.4]), 0.5)[0] == pytest.approx(0.5)
