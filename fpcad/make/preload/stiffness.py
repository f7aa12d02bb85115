"""How soft fingers and grip are: servo and tendon in series, seen at joints, contacts and tool."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.make.preload.touch import Touch
from fpcad.make.servo import servo_of
from fpcad.model.transmission import hand_transmission, motor_torques
from fpcad.spec.catalogue import motor
from fpcad.spec.schema import Spec
from fpcad.spec.templates import TEMPLATES
from fpcad.units import NM_PER_NMM

Array = NDArray[np.float64]

STRANDS = 2
"""Strands of a motor's closed loop that share its load, both kept tight by the tensioner."""


@dataclass(frozen=True)
class HandStiffness:
    """Stiffness of a hand whose motors are told where to stand."""

    A: Array
    """(n_motors, n_u): motor angles are A times joint angles."""
    motor_nmm_rad: float
    """Torque at a spool [N mm] for a turn of the joints that moves it by one radian."""
    skin_n_mm: float
    """Stiffness of the skin under a contact [N/mm]."""

    @property
    def joint_nmm_rad(self) -> Array:
        """(n_u, n_u) joint stiffness K_q = A^T K_m A [N mm/rad]."""
        return self.motor_nmm_rad * self.A.T @ self.A

    def joint_offset(self, torque_nmm: Array) -> Array:
        """How far commands (..., n_u) [rad] must lie ahead of the joints for torques (..., n_u)."""
        return torque_nmm @ np.asarray(np.linalg.inv(self.joint_nmm_rad), dtype=np.float64)

    def motor_torque(self, torque_nmm: Array) -> Array:
        """Motor torques (..., n_motors) [N mm] that hold joint torques (..., n_u) [N mm]."""
        return motor_torques(self.A, torque_nmm)


def hand_stiffness(spec: Spec) -> HandStiffness:
    """From the spec's `grip`, or the catalogue's estimate where it leaves the servo open."""
    servo = servo_stiffness_nm_rad(spec) / NM_PER_NMM
    in_series = 1.0 / (1.0 / tendon_stiffness_nmm_rad(spec) + 1.0 / servo)
    A = hand_transmission(spec.motors.transmission, len(TEMPLATES[spec.hand.template].fingers))
    return HandStiffness(A, in_series, spec.grip.skin_stiffness_n_mm)


def servo_stiffness_nm_rad(spec: Spec) -> float:
    """Stiffness of a servo at its shaft [N m/rad]."""
    told = spec.grip.servo_stiffness_nm_rad
    return servo_of(motor(spec.motors.type)).stiffness_nm_rad if told is None else told


def tendon_stiffness_nmm_rad(spec: Spec) -> float:
    """Stiffness of a motor's loop as its spool feels it [N mm/rad]: EA / L at the spool's radius."""
    strand = spec.grip.tendon_stiffness_n / spec.grip.tendon_length_mm
    return STRANDS * strand * spec.motors.transmission.spool_radius_mm**2


def contact_stiffness(touch: Touch, stiffness: HandStiffness, forces: Array | None = None) -> Array:
    """(N, 3n, 3n) forces on the tool [N] for displacements [mm] of the contacts, in their axes.

    Fingers yield by J K_q^-1 J^T, the skin by its own compliance, alike in all directions. With
    contact forces (N, 3n) [N], K_q holds what the levers of these forces add when joints turn.
    """
    joint = stiffness.joint_nmm_rad
    if forces is not None:
        joint = joint + _lever_stiffness(touch, forces)
    to_torque = touch.torque_map
    yielding = np.swapaxes(to_torque, 1, 2) @ np.linalg.inv(joint) @ to_torque
    skin = np.eye(yielding.shape[1]) / stiffness.skin_n_mm
    return np.asarray(np.linalg.inv(yielding + skin), dtype=np.float64)


def grasp_stiffness(touch: Touch, stiffness: HandStiffness, forces: Array | None) -> Array:
    """(N, 6, 6) wrench that resists the tool's small motion, contacts sticking like ball joints.

    Displacement [mm] and rotation [rad] at the tool's centre in H. The forces (N, 3n) [N] count:
    they turn with arms and fingers, and a hard grip with soft fingers may snap away.
    docs/preload.md has the equations.
    """
    grasp = touch.grasp_map
    elastic = grasp @ contact_stiffness(touch, stiffness, forces) @ np.swapaxes(grasp, 1, 2)
    if forces is None:
        return elastic
    pressing = _in_palm(touch, forces)
    arms = touch.points_mm - touch.centre_mm[:, None]
    turning = np.einsum("kni,kni->k", pressing, arms)[:, None, None] * np.eye(3)
    turning -= np.einsum("kni,knj->kij", arms, pressing)
    elastic[:, 3:, 3:] += (turning + np.swapaxes(turning, 1, 2)) / 2
    return elastic


def _lever_stiffness(touch: Touch, forces: Array) -> Array:
    """(N, n_u, n_u) second derivatives by the joints of the work that the forces do [N mm/rad^2].

    Turning joint j turns the velocity that a joint k further out gives the contact.
    """
    levers = np.cross(_in_palm(touch, forces)[:, :, None], touch.joint_axes[:, None])
    by_joints = np.einsum("knji,kniu->kju", levers, touch.jacobians_mm)
    one_finger = np.kron(np.eye(by_joints.shape[1] // 3), np.triu(np.ones((3, 3))))
    outward = by_joints * one_finger
    diagonal = np.einsum("kjj->kj", outward)[:, :, None] * np.eye(by_joints.shape[1])
    return outward + np.swapaxes(outward, 1, 2) - diagonal


def _in_palm(touch: Touch, forces: Array) -> Array:
    """Forces (N, n, 3) in H of forces (N, 3n) in the contacts' axes."""
    return np.einsum("knij,knj->kni", touch.axes, forces.reshape(*touch.points_mm.shape))
