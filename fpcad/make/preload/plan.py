"""Grip preload of a trajectory: forces along the path, commands that make them, and their margins."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from fpcad.make.grip import Grip
from fpcad.make.preload.forces import GripDemand, balance_residual, grip_forces
from fpcad.make.preload.margins import (
    Margins,
    cone_share,
    least_stiffness,
    load_until_slip,
    shared_out,
    slip_margin,
    with_errors,
)
from fpcad.make.preload.stiffness import HandStiffness, hand_stiffness
from fpcad.make.preload.touch import FORCE_AXES, Touch, touch
from fpcad.spec.catalogue import motor
from fpcad.spec.schema import Spec
from fpcad.units import NM_PER_NMM, RAD_PER_DEG

Array = NDArray[np.float64]

GRAVITY_M_S2 = 9.81
KG_PER_G = 1e-3
DAMPING_MM = 1.0
"""Lever [mm] below which a joint is no means to sink a finger into the skin."""
SOFTENING_ROUNDS = 5
"""How often forces are lowered for stiffness; what is then missing shows in the margins."""
CLOSE_ENOUGH = 0.98
"""Share of the needed stiffness with which forces are no longer lowered."""
CELL_RAD = np.radians(1.0)
"""Spacing of the states that forces are planned for; between them they are interpolated."""


@dataclass(frozen=True)
class Preload:
    """What a trajectory's knots command to grip the tool; N knots, n contacts."""

    position_rad: Array
    """(N, n_u) commanded joint positions."""
    forces_n: Array
    """(N, n, 3) on the tool: normal, along the tool, around it."""
    margins: Margins


def grip_preload(spec: Spec, grip: Grip, joints: Array, angles: Array) -> Preload:
    """Commands that grip the tool along states in contact.

    Args:
        spec: its `grip`, friction and motors.
        grip: hand, tool and contacts.
        joints: (N, n_u) [rad] in contact with the tool.
        angles: (N,) tool angle [rad] of each state; equal angles have equal joints.

    Raises:
        MakeError: no forces balance within the motors' torque.
    """
    stiffness = hand_stiffness(spec)
    turned, first = np.unique(angles, return_index=True)
    planned = _planned_forces(spec, grip, stiffness, turned, joints[first])
    contacts = touch(grip, joints, angles)
    forces = planned(angles)
    forces = forces - balance_residual(contacts, forces, gravity_load(spec, len(angles)))
    torque = np.einsum("kuf,kf->ku", contacts.torque_map, forces)
    offset = stiffness.joint_offset(torque) + _skin_offset(contacts, forces, stiffness)
    return Preload(
        joints + offset,
        forces.reshape(len(joints), -1, FORCE_AXES),
        _margins(spec, grip, contacts, forces, stiffness, angles),
    )


def gravity_load(spec: Spec, states: int) -> Array:
    """(states, 6) the tool's weight [N] over its moment [N mm] about the tool's centre, in H."""
    down = np.array(spec.grip.gravity) / np.linalg.norm(spec.grip.gravity)
    weight = spec.grip.tool_mass_g * KG_PER_G * GRAVITY_M_S2 * down
    return np.tile(np.concatenate([weight, np.zeros(3)]), (states, 1))


def _planned_forces(
    spec: Spec, grip: Grip, stiffness: HandStiffness, turned: Array, joints: Array
) -> Callable[[Array], Array]:
    """Forces (N, 3n) [N] over the tool angle, planned on an even grid along the path."""
    cells = int(np.ceil((turned[-1] - turned[0]) / CELL_RAD - 1e-9))
    grid = np.linspace(turned[0], turned[-1], cells + 1)
    contacts = touch(grip, _over(turned, joints)(grid), grid)
    motor_torque = np.asarray(np.linalg.solve(stiffness.A.T, contacts.torque_map), dtype=float)
    whole = least_stiffness(contacts, stiffness, None)
    needed = spec.grip.stiffness_share * whole
    least, most = np.full(len(grid), spec.grip.min_normal_force_n), np.full(len(grid), np.inf)
    for tries in range(SOFTENING_ROUNDS):
        forces = grip_forces(contacts, motor_torque, _demand(spec, grid, least, most))
        given = least_stiffness(contacts, stiffness, forces)
        if np.all(given >= CLOSE_ENOUGH * needed):
            break
        factor = _bearable(whole, given, needed)
        least = least * factor
        if tries:  # asking for less was not enough, for the load itself asks for much
            pressed = factor * forces[:, ::FORCE_AXES].max(axis=1)
            most = np.where(factor < 1.0, np.minimum(most, pressed), most)
            least = np.minimum(least, most)
    return _over(grid, forces)


def _bearable(whole: Array, given: Array, needed: Array) -> Array:
    """Factors (N,) on forces that leave the stiffness (N,) needed of the whole one.

    What forces take from it grows in proportion to them, nearly.
    """
    return np.minimum(1.0, (whole - needed) / np.maximum(whole - given, 1e-9))


def _demand(spec: Spec, grid: Array, least: Array, most: Array) -> GripDemand:
    settings = spec.grip
    return GripDemand(
        load=gravity_load(spec, len(grid)),
        least_normal_n=least,
        most_normal_n=most,
        friction=settings.cone_share * spec.statics.friction,
        motor_limit_nmm=settings.motor_share * _continuous_nmm(spec),
        spacing_rad=np.diff(grid),
        smoothing_rad=settings.smoothing_deg * RAD_PER_DEG,
    )


def _over(angles: Array, values: Array) -> Callable[[Array], Array]:
    """Values (N, k) over increasing angles (N,): monotone between them, never beyond them."""
    if len(angles) == 1:
        return lambda wanted: np.repeat(values, len(wanted), axis=0)
    return PchipInterpolator(angles, values)


def _skin_offset(contacts: Touch, forces: Array, stiffness: HandStiffness) -> Array:
    """(N, n_u) [rad] by which joints must sink contacts into the skin: J dq = n f_n / k.

    Least squares with a touch of damping, for a straight finger cannot move along itself.
    """
    pressed = np.zeros_like(forces)
    pressed[:, ::FORCE_AXES] = forces[:, ::FORCE_AXES] / stiffness.skin_n_mm
    J = np.swapaxes(contacts.torque_map, 1, 2)
    damped = contacts.torque_map @ J + DAMPING_MM**2 * np.eye(J.shape[2])
    moved = np.linalg.solve(damped, contacts.torque_map @ pressed[..., None])
    return np.asarray(moved[..., 0], dtype=np.float64)


def _margins(
    spec: Spec, grip: Grip, contacts: Touch, forces: Array, stiffness: HandStiffness, angles: Array
) -> Margins:
    friction = spec.statics.friction
    motor_torque = stiffness.motor_torque(np.einsum("kuf,kf->ku", contacts.torque_map, forces))
    wrong = with_errors(contacts, stiffness, forces)
    change = shared_out(contacts, stiffness, tip_wrench(grip, contacts, angles))
    tip = [load_until_slip(forces, sign * change, friction).min() for sign in (1.0, -1.0)]
    return Margins(
        least_normal_n=float(forces[:, ::FORCE_AXES].min()),
        cone_share=float(cone_share(forces, friction).max()),
        slip_margin_n=float(slip_margin(forces, friction).min()),
        slip_margin_with_error_n=float(slip_margin(wrong, friction).min()),
        motor_share=float(np.abs(motor_torque).max() / _continuous_nmm(spec)),
        least_stiffness_n_mm=float(least_stiffness(contacts, stiffness, forces).min()),
        tip_force_n=float(min(tip)),
    )


def tip_wrench(grip: Grip, contacts: Touch, angles: Array) -> Array:
    """(N, 6) wrench of a force of 1 N at the tip against a positive turning, at the tool's centre.

    The force has the direction of -omega x (tip - pivot) and turns with the tool.
    """
    _, orientation = grip.tool_poses(angles)
    tip = np.array([grip.tool.tip_mm, 0.0, 0.0])
    sweep = np.cross(grip.turning.axis, tip - np.array(grip.turning.pivot_mm))
    centre = np.array([(grip.tool.back_mm + grip.tool.tip_mm) / 2, 0.0, 0.0])
    force = orientation.apply(-sweep / np.linalg.norm(sweep))
    return np.hstack([force, np.cross(orientation.apply(tip - centre), force)])


def _continuous_nmm(spec: Spec) -> float:
    return motor(spec.motors.type).continuous_torque_nm / NM_PER_NMM
