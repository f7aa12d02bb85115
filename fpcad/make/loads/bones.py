"""Stress in the printed bones of a finger, beam by beam, where it is greatest."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fpcad.make.loads.finger import FingerForces, hub_places
from fpcad.make.loads.frames import transfer_points
from fpcad.make.loads.pins import across, prong_forces
from fpcad.make.loads.sections import Section, sections
from fpcad.make.loads.supports import Z
from fpcad.make.parts.bone import ip_knot, prong_start
from fpcad.make.parts.dimensions import Dimensions
from fpcad.make.parts.mcp_clearances import neck_start

Array = NDArray[np.float64]

STEP_MM = 0.75
"""Between the sections that are tried along a bone."""
EDGE_MM = 0.1
"""From where a beam begins, so that no section lies in a face."""
WIDE_MM = 50.0


@dataclass(frozen=True)
class Pushes:
    """Forces (K, n, 3) at points (K, n, 3), and a moment (K, 3): all that acts beyond a section."""

    at: Array
    force: Array
    moment: Array

    def about(self, section: Section) -> tuple[Array, Array]:
        """Force and moment (K, 3) at a section's centroid of what acts beyond it (greater x)."""
        beyond = self.force * (self.at[:, :, :1] > section.x)
        arms = self.at - section.centroid
        return beyond.sum(axis=1), np.cross(arms, beyond).sum(axis=1) + self.moment


@dataclass(frozen=True)
class Beam:
    """A part of a bone that bends as one beam along x of its link's frame."""

    where: str
    part: str
    """The printed part."""
    start: float
    end: float
    low: tuple[float, float] = (-WIDE_MM, -WIDE_MM)
    """Least y and z of the middles of its pieces."""
    high: tuple[float, float] = (WIDE_MM, WIDE_MM)

    def sections(self, mesh: trimesh.Trimesh) -> list[Section]:
        """Its sections, some tenths of a millimetre apart."""
        span = self.end - self.start - 2 * EDGE_MM
        places = (
            self.start + EDGE_MM + np.linspace(0, span, 1 + math.ceil(max(span, 0.0) / STEP_MM))
        )
        return sections(mesh, places, np.array(self.low), np.array(self.high))


Loaded = tuple[Beam, Callable[[Dimensions, FingerForces, Array], Pushes]]
"""A beam, and what acts on it for the joint angles (K, 3) of a finger."""


class Bones:
    """The beams of one hand's fingers, cut once: fingers are alike."""

    def __init__(self, d: Dimensions, meshes: Mapping[str, trimesh.Trimesh]) -> None:
        self._d = d
        self._cut = [(beam, beam.sections(meshes[beam.part]), push) for beam, push in beams(d)]
        self._bridges = bridge_sections(d, meshes["mcp_cross"])

    def stresses(self, forces: FingerForces, joints: Array) -> dict[str, Array]:
        """Largest stress (K,) [MPa] of each beam, for joint angles (K, 3) of a finger."""
        found = {}
        for beam, cut, push in self._cut:
            pushes = push(self._d, forces, joints)
            each = [section.stress_mpa(*pushes.about(section)) for section in cut]
            found[beam.where] = np.max(each, axis=0)
        return found

    def bridge_stress(self, forces: FingerForces) -> Array:
        """Larger stress (K,) [MPa] of the cross's two bridges."""
        return bridge_stress(self._d, self._bridges, forces)


def beams(d: Dimensions) -> list[Loaded]:
    """Every beam of a finger's bones, with what bends it."""
    k, m = d.knuckle, d.mcp
    slot, hole = prong_start(d), d.proximal_length - k.bearing.bore_mm / 2 - m.hold
    seat = k.bearing.outer_mm / 2 + m.hold
    hub, neck = m.disc_rim, neck_start(m)
    below, above = (-WIDE_MM, -WIDE_MM), (WIDE_MM, WIDE_MM)
    return [
        (Beam("distal bone", "distal_bone", seat, d.distal_axis_length), _on_distal),
        (Beam("shaft of the proximal bone", "proximal_bone", d.shaft_start, slot), _on_shaft),
        (Beam("neck of the proximal bone", "proximal_bone", neck, d.shaft_start), _on_shaft),
        (Beam("prong at -y", "proximal_bone", slot, hole, high=(0.0, WIDE_MM)), _on_prong(0)),
        (Beam("prong at +y", "proximal_bone", slot, hole, low=(0.0, -WIDE_MM)), _on_prong(1)),
        (
            Beam("output pulley's arm", "proximal_bone", hub, neck, below, (WIDE_MM, 0.0)),
            _on_arm(0),
        ),
        (Beam("dorsal arm", "proximal_bone", hub, neck, (-WIDE_MM, 0.0), above), _on_arm(1)),
    ]


def _on_distal(d: Dimensions, forces: FingerForces, joints: Array) -> Pushes:
    """Contact and the strands' knot, in the distal frame."""
    turned = Rotation.from_euler("zy", joints[:, 1:]).inv()
    back = Rotation.from_euler("z", joints[:, 1, None]).inv()
    axis = np.array([d.proximal_length, 0.0, 0.0])
    point = Rotation.from_euler("y", -joints[:, 2, None]).apply(
        back.apply(forces.contact_at) - axis
    )
    x, z = ip_knot(d)
    knot, pull = np.tile([x, 0.0, z], (len(joints), 1)), np.zeros((len(joints), 3))
    pull[:, 0] = -forces.knot
    on_distal = forces.contact * forces.on_distal
    at, force = np.stack([point, knot], axis=1), np.stack([turned.apply(on_distal), pull], axis=1)
    return Pushes(at, force, np.zeros_like(pull))


def _on_shaft(d: Dimensions, forces: FingerForces, joints: Array) -> Pushes:
    """The IP pin, and what touches the proximal link, in the proximal frame."""
    back = Rotation.from_euler("z", joints[:, 1, None]).inv()
    pin = np.tile([d.proximal_length, 0.0, 0.0], (len(joints), 1))
    touching = back.apply(forces.contact * (not forces.on_distal))
    at = np.stack([pin, back.apply(forces.contact_at)], axis=1)
    return Pushes(at, np.stack([-forces.ip_force, touching], axis=1), -forces.ip_moment)


def _on_prong(side: int) -> Callable[[Dimensions, FingerForces, Array], Pushes]:
    """One prong's share of the IP pin."""

    def push(d: Dimensions, forces: FingerForces, joints: Array) -> Pushes:
        middle = (d.knuckle.prong_inner + d.knuckle.prong_outer) / 2
        pin = np.array([d.proximal_length, (-1, 1)[side] * middle, 0.0])
        force = prong_forces(d, forces)[:, side, None]
        return Pushes(np.tile(pin, (len(joints), 1, 1)), force, np.zeros((len(joints), 3)))

    return push


def _on_arm(side: int) -> Callable[[Dimensions, FingerForces, Array], Pushes]:
    """A hub's pin, and on the palmar side the transfer strands: all this side of the sections.

    The bone is in balance, so what lies beyond pulls the other way.
    """

    def push(d: Dimensions, forces: FingerForces, joints: Array) -> Pushes:
        states = len(joints)
        back = Rotation.from_euler("z", joints[:, 1, None]).inv()
        at = [np.array([0.0, 0.0, hub_places(d)[side]])]
        load = [forces.hubs[:, side].copy()]
        thrust = (
            forces.hub_thrust
        )  # up, the palmar hub leans on its bridge; down, the arm on the idler
        load[0][:, 2] += np.maximum(thrust, 0.0) if side == 0 else np.minimum(thrust, 0.0)
        if side == 0:
            at += list(transfer_points(d))
            load += [np.outer(t, [-1.0, 0.0, 0.0]) for t in forces.tensions.palmar.T]
        points = np.stack([back.apply(np.tile(p, (states, 1))) for p in at], axis=1)
        inboard = np.stack([back.apply(f) for f in load], axis=1)
        total = inboard.sum(axis=1)
        about_root = np.cross(points, inboard).sum(axis=1)
        far = np.tile([WIDE_MM, 0.0, 0.0], (states, 1))  # the same force and moment from beyond
        moment = -about_root + np.cross(far, total)
        return Pushes(far[:, None], -total[:, None], moment)

    return push


def bridge_sections(d: Dimensions, cross: trimesh.Trimesh) -> tuple[Section, Section]:
    """The middles of the cross's two bridges, palmar and dorsal, cut across y; their y, z are z, x."""
    turned = cross.copy()
    turned.vertices = np.asarray(cross.vertices)[:, [1, 2, 0]]
    low, high = np.array([-WIDE_MM, -WIDE_MM]), np.array([WIDE_MM, WIDE_MM])
    (palmar,) = sections(turned, [EDGE_MM], low, np.array([0.0, WIDE_MM]))
    (dorsal,) = sections(turned, [EDGE_MM], np.array([0.0, -WIDE_MM]), high)
    return palmar, dorsal


def bridge_stress(d: Dimensions, bridges: tuple[Section, Section], forces: FingerForces) -> Array:
    """Larger stress (K,) [MPa] of both bridges, as beams that rest on the cheeks: F l / 4."""
    span = d.mcp.cheek_inner + d.mcp.cheek_outer
    pins = (forces.hubs[:, 0], forces.hubs[:, 1] - forces.idler)
    found = []
    for section, pin in zip(bridges, pins, strict=True):
        moment = np.zeros_like(pin)
        moment[:, 1] = across(pin, Z) * span / 4
        found.append(section.stress_mpa(np.zeros_like(pin), moment))
    return np.maximum(*found)
