"""Forces inside one finger: what each link, bearing and pin pushes on its neighbour with.

Links are massless and joints free of friction. All forces are those *on* the body named, in the
frame that flexion carries (x along the straight finger, y flexion axis, z abduction axis), but for
the IP joint's, which are in the proximal bone's frame. docs/loads.md has the free bodies.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fpcad.make.loads.frames import (
    STRANDS,
    ip_pull,
    motor_pulls,
    to_flexed,
    transfer_points,
)
from fpcad.make.loads.strands import Tensions
from fpcad.make.loads.supports import Y, Z, on_axis
from fpcad.make.parts.dimensions import Dimensions

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Touched:
    """What touches one finger in K states."""

    joints_rad: Array
    """(K, 3)"""
    point_mm: Array
    """(K, 3) in H."""
    force_n: Array
    """(K, 3) that the tool pushes the finger with, in H; zero where it does not touch."""
    on_distal: bool


@dataclass(frozen=True)
class FingerForces:
    """Reactions in one finger in K states [N, N mm]."""

    tensions: Tensions
    contact_at: Array
    """(K, 3) contact in the flexed frame [mm]."""
    contact: Array
    """(K, 3) its force."""
    on_distal: bool
    """Which link it touches."""
    knot: Array
    """(K,) pull of both IP strands on their knot in the distal bone."""
    ip_force: Array
    """(K, 3) on the distal bone from its two bearings together."""
    ip_moment: Array
    """(K, 3) about the IP axis's middle, from the same; nothing about y but what does not balance."""
    hubs: Array
    """(K, 2, 3) on the proximal bone from the palmar and the dorsal abduction pin, across them."""
    hub_thrust: Array
    """(K,) on the proximal bone along the abduction axis."""
    idler: Array
    """(K, 3) on the dorsal pin from the idler."""
    cheeks: Array
    """(K, 2, 3) on the cross from the axle, at -y and +y."""
    axle_loads: Array
    """(K, n, 3) across the axle: both cheeks, input pulleys' and drum's strands, the palm's ears."""
    axle_places: Array
    """(n,) their y."""
    ears: Array
    """(K, 2, 3) on the axle and what it carries from the palm's ears, at -y and +y; of the thrust
    along the axle each is given half."""
    unbalanced: Array
    """(K, 3) moments that free joints cannot take: about IP, abduction and flexion axis. Zero where
    motor torques are those of the contact."""


def finger_forces(
    d: Dimensions, T_palm_root: Array, touched: Touched, tension: Tensions
) -> FingerForces:
    """All reactions of a finger, from the tip inwards."""
    u = touched.joints_rad
    at, contact = to_flexed(T_palm_root, u[:, 0], touched.point_mm, touched.force_n)
    ip_force, ip_moment = _ip_joint(d, u, at, contact * touched.on_distal, tension)
    hubs, thrust, about_z = _abduction(
        d, u, (ip_force, ip_moment), (at, contact * (not touched.on_distal)), tension
    )
    idler = np.zeros_like(contact)
    idler[:, 0] = -2 * tension.dorsal
    cheeks, push, about_y = _cross(d, hubs, thrust, idler)
    places, loads = _axle_loads(d, T_palm_root, u, cheeks - push[:, None] / 2, tension)
    ears = _ears(d, places, loads)
    return FingerForces(
        tensions=tension,
        contact_at=at,
        contact=contact,
        on_distal=touched.on_distal,
        knot=tension.ip_flexor + tension.ip_extensor,
        ip_force=ip_force,
        ip_moment=ip_moment,
        hubs=hubs,
        hub_thrust=thrust,
        idler=idler,
        cheeks=cheeks,
        axle_loads=np.concatenate([loads, ears], axis=1) * np.array([1.0, 0.0, 1.0]),
        axle_places=np.concatenate([places, _ear_places(d)]),
        ears=ears,
        unbalanced=np.stack([ip_moment[:, 1], about_z, about_y], axis=1),
    )


def _ip_joint(
    d: Dimensions, u: Array, at: Array, contact: Array, tension: Tensions
) -> tuple[Array, Array]:
    """Force and moment (K, 3) of the bearings on the distal bone, in the proximal frame."""
    back = Rotation.from_euler("z", -u[:, 1, None])
    point, force = back.apply(at), back.apply(contact)
    centre = np.array([d.proximal_length, 0.0, 0.0])
    total, moment = force.copy(), np.cross(point - centre, force)
    for side, pulled in ((-1, tension.ip_flexor), (1, tension.ip_extensor)):
        pull = ip_pull(d, side)
        total += pulled[:, None] * pull.direction
        moment += pulled[:, None] * np.cross(pull.at - centre, pull.direction)
    return -total, -moment


def _abduction(
    d: Dimensions,
    u: Array,
    ip: tuple[Array, Array],
    contact: tuple[Array, Array],
    tension: Tensions,
) -> tuple[Array, Array, Array]:
    """Hubs (K, 2, 3) and thrust (K,) on the proximal bone, and what is left about z (K,)."""
    forward = Rotation.from_euler("z", u[:, 1, None])
    pin, twist = (forward.apply(-v) for v in ip)
    axis = forward.apply([d.proximal_length, 0.0, 0.0])
    at, push = contact
    total = pin + push
    moment = np.cross(axis, pin) + twist + np.cross(at, push)
    for k, point in enumerate(transfer_points(d)):
        pulled = tension.palmar[:, k, None] * np.array([-1.0, 0.0, 0.0])
        total = total + pulled
        moment = moment + np.cross(point, pulled)
    return on_axis(-total, -moment, Z, hub_places(d)), -total[:, 2], moment[:, 2]


def _cross(d: Dimensions, hubs: Array, thrust: Array, idler: Array) -> tuple[Array, Array, Array]:
    """Axle's push (K, 2, 3) on the cheeks, what thrusts the cross along y (K, 3), and what is left about y."""
    low, high = hub_places(d)
    loads = [-hubs[:, 0], -hubs[:, 1], idler]
    heights = (low, high, d.mcp.input_radius)
    total = np.sum(loads, axis=0)
    total[:, 2] -= thrust
    moment = np.sum(
        [np.cross([0.0, 0.0, z], load) for z, load in zip(heights, loads, strict=True)], axis=0
    )
    cheek = (d.mcp.cheek_inner + d.mcp.cheek_outer) / 2
    push = np.zeros_like(total)
    push[:, 1] = total[:, 1]
    return on_axis(-total, -moment, Y, (-cheek, cheek)), push, moment[:, 1]


def _axle_loads(
    d: Dimensions, T_palm_root: Array, u: Array, cheeks: Array, tension: Tensions
) -> tuple[Array, Array]:
    """Places (n,) along y and loads (K, n, 3) on the axle, the palm's ears left out."""
    m = d.mcp
    cheek = (m.cheek_inner + m.cheek_outer) / 2
    places, loads = [-cheek, cheek], [-cheeks[:, 0], -cheeks[:, 1]]
    pulls = motor_pulls(d, T_palm_root, u[:, 0])
    by_motor = np.stack([tension.flexor, tension.extensor], axis=2).reshape(len(u), -1)
    for k, name in enumerate(STRANDS):
        pull = pulls[name]
        places.append(float(pull.at[0, 1]))
        loads.append(by_motor[:, k, None] * pull.direction)
    for k, side in enumerate((1.0, -1.0)):
        handed_over = np.zeros_like(loads[0])
        handed_over[:, 0] = tension.palmar[:, k] + tension.dorsal
        places.append(side * m.output_radius)
        loads.append(handed_over)
    places += [-m.drum_half, m.drum_half]
    loads += list(np.moveaxis(_drum(d, u, tension), 1, 0))
    return np.array(places), np.stack(loads, axis=1)


def _drum(d: Dimensions, u: Array, tension: Tensions) -> Array:
    """What the drum's ends push the axle with, (K, 2, 3), for the finger's two strands on it."""
    forward = Rotation.from_euler("z", u[:, 1, None])
    force, moment = np.zeros((len(u), 3)), np.zeros((len(u), 3))
    for side, pulled in ((-1, tension.ip_flexor), (1, tension.ip_extensor)):
        pull = ip_pull(d, side)
        force -= pulled[:, None] * forward.apply(pull.direction)
        moment -= pulled[:, None] * forward.apply(np.cross(pull.at, pull.direction))
    ends = on_axis(force, moment, Y, (-d.mcp.drum_half, d.mcp.drum_half))
    ends[:, :, 1] = force[:, 1, None] / 2
    return ends


def _ears(d: Dimensions, places: Array, loads: Array) -> Array:
    """(K, 2, 3) on the axle from the palm's ears."""
    levers = np.zeros((len(places), 3))
    levers[:, 1] = places
    moment = np.cross(levers[None], loads).sum(axis=1)
    low, high = _ear_places(d)
    total = loads.sum(axis=1)
    ears = on_axis(-total, -moment, Y, (float(low), float(high)))
    ears[:, :, 1] = -total[:, 1, None] / 2
    return ears


def _ear_places(d: Dimensions) -> Array:
    middle = d.mcp.ear_inner + d.mcp.axle_seat / 2
    return np.array([-middle, middle])


def hub_places(d: Dimensions) -> tuple[float, float]:
    """Z of the middles of the proximal bone's hubs on the abduction pins: palmar, dorsal [mm]."""
    m = d.mcp
    return -(m.disc_inner + m.pivot_outer) / 2, (m.arm_inner + m.pivot_outer) / 2
