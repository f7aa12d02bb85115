"""Friction cones, wrenches and torques: against their definition, and against cases done by hand."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from fpcad.model.equilibrium import greatest_load, least_torque
from fpcad.model.frames import Frame
from fpcad.model.statics import cone_axes, cone_edges, cone_facets, tip_wrench, unit_forces
from fpcad.model.surfaces import cylinder_point, turned_tool
from fpcad.solve.attempt import Workbench
from fpcad.spec.pose import Turning
from fpcad.spec.process import Statics
from fpcad.spec.tool import CylinderTool
from tests.model.plain_hand import FINGERS, Array
from tests.model.postures import random_posture

TOOL = CylinderTool(radius_mm=6, back_mm=-80, tip_mm=80)
OCTAGON = cone_facets(Statics(cone_facets=8))
ARM_MM = 50.0
"""Lever of each finger's only joint in the cases done by hand."""


class Fingers:
    """Fingers with one joint each that pushes its contact along the tool's normal, by hand.

    A joint rate of 1 rad/s moves the contact by ARM_MM against the tool's outward normal, so a
    normal force N needs the torque N ARM_MM, and friction needs none.
    """

    def __init__(self, friction: float, *contacts: tuple[float, float]) -> None:
        statics = Statics(friction=friction, cone_facets=8)
        wrench, torque = [], []
        for i, (axial, angle) in enumerate(contacts):
            point = cylinder_point(TOOL, axial, angle)
            jacobian = ca.DM.zeros(3, len(contacts))
            jacobian[:, i] = -ARM_MM * point.normal
            forces = unit_forces(cone_axes(statics, point), point, jacobian)
            wrench.append(np.array(ca.DM(forces.wrench)))
            torque.append(np.array(ca.DM(forces.torque)))
        self.wrench, self.torque = np.hstack(wrench), np.hstack(torque)

    def torque_for(self, load: Array, cap: float = 1e6) -> float | None:
        """Least largest torque [N mm] against a load; None where it cannot be held."""
        holding = least_torque(self.wrench, self.torque, load, cap, OCTAGON)
        return None if holding is None else holding.largest_torque_nmm

    def load_within(self, load: Array, limit: float) -> float:
        """Largest multiple of a load within a torque limit [N mm] of each joint."""
        limits = np.full(len(self.torque), limit)
        return greatest_load(self.wrench, self.torque, load, limits, OCTAGON)


PULL = np.array([-10.0, 0, 0, 0, 0, 0])  # 10 N along the tool's axis, through O


@pytest.mark.parametrize("friction", [0.3, 0.8, 2.0])
class TestPinch:
    """Thumb and finger opposite each other, and a pull along the tool.

    Only friction resists it, mu N at each of the two contacts, so 2 mu N = F: each joint needs
    the torque ARM F / (2 mu). The axial direction is an edge of the pyramid, so it is exact.
    """

    def test_needs_half_the_load_over_friction(self, friction: float):
        pinch = Fingers(friction, (0.0, 0.0), (0.0, np.pi))
        assert pinch.torque_for(PULL) == pytest.approx(ARM_MM * 10 / (2 * friction))

    def test_does_not_hold_beyond_the_cap(self, friction: float):
        pinch = Fingers(friction, (0.0, 0.0), (0.0, np.pi))
        needed = ARM_MM * 10 / (2 * friction)
        assert pinch.torque_for(PULL, cap=needed * 1.001) is not None
        assert pinch.torque_for(PULL, cap=needed * 0.999) is None

    def test_gives_as_much_as_its_torque(self, friction: float):
        pinch = Fingers(friction, (0.0, 0.0), (0.0, np.pi))
        assert pinch.load_within(PULL / 10, 200.0) == pytest.approx(2 * friction * 200 / ARM_MM)

    def test_cannot_resist_turning_about_its_own_axis(self, friction: float):
        """Both contacts lie on the y axis: no force there has a moment about it."""
        pinch = Fingers(friction, (0.0, 0.0), (0.0, np.pi))
        twist = np.array([0.0, 0, 0, 0, 10, 0])
        assert pinch.torque_for(twist) is None
        assert pinch.load_within(twist, 1e6) < 1e-12


class TestLever:
    """A thumb below the tool, two fingers above it at +-25 mm, 1 N down at the tip, hardly friction.

    Forces T up at 0, I down at +25, R down at -25, F = 1 down at 80. Moments about z:
    25 (R - I) = 80 F, so R = I + 3.2 F; forces: T = I + R + F = 2 I + 4.2 F. Nothing else acts,
    so the least largest force has I = 0: the thumb's torque is 4.2 F ARM.
    """

    CONTACTS = ((0.0, np.pi), (25.0, 0.0), (-25.0, 0.0))
    DOWN = np.array([0.0, -1, 0, 0, 0, -80])

    def test_thumb_carries_most(self):
        lever = Fingers(1e-9, *self.CONTACTS)
        assert lever.torque_for(self.DOWN) == pytest.approx(4.2 * ARM_MM, rel=1e-6)

    def test_up_is_carried_by_the_front_finger(self):
        """The same with F up: I = R + 3.2 F and T = I + R - F = 2 R + 2.2 F, so I carries most."""
        lever = Fingers(1e-9, *self.CONTACTS)
        assert lever.torque_for(-self.DOWN) == pytest.approx(3.2 * ARM_MM, rel=1e-6)

    def test_friction_helps(self):
        """Friction along the tool, T mu at its lower and I mu, R mu at its upper side, acts at a
        lever of 6 mm: less is needed than without."""
        rough, smooth = Fingers(0.8, *self.CONTACTS), Fingers(1e-9, *self.CONTACTS)
        with_friction, without = rough.torque_for(self.DOWN), smooth.torque_for(self.DOWN)
        assert with_friction is not None and without is not None
        assert with_friction < 0.95 * without


@pytest.mark.parametrize("facets", [3, 8, 13])
@pytest.mark.parametrize("friction", [0.2, 0.8])
def test_edges_lie_on_the_coulomb_cone(friction: float, facets: int):
    point = cylinder_point(TOOL, 10.0, 0.7)
    statics = Statics(friction=friction, cone_facets=facets)
    edges = np.array(ca.DM(cone_axes(statics, point))) @ cone_edges(statics)
    normal = np.array(ca.DM(point.normal)).ravel()
    assert edges.shape == (3, facets)
    assert np.allclose(-normal @ edges, 1)  # the finger pushes into the tool
    tangential = edges + np.outer(normal, -normal @ edges)
    assert np.allclose(np.linalg.norm(tangential, axis=0), friction)
    assert np.allclose(edges.mean(axis=1), -normal)
    assert np.linalg.matrix_rank(edges) == 3


@pytest.mark.parametrize("facets", [3, 8, 13])
def test_facets_are_the_sides_between_the_edges(facets: int):
    """Each side holds two neighbouring edges, and all others lie inside."""
    statics = Statics(cone_facets=facets)
    heights = cone_facets(statics) @ cone_edges(statics)
    assert np.allclose(np.sort(heights, axis=1)[:, -2:], 0)
    assert (np.sort(heights, axis=1)[:, :-2] < -1e-3).all()


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("pose", ["carve", "poke"])
def test_wrenches_are_forces_at_the_contact_points(bench: Workbench, pose: str, seed: int):
    at = random_posture(bench.spec, pose, seed)
    wrench, torque, tip = bench.kernels[pose].statics(at.d, at.h, at.turn, at.x)
    for i in range(len(at.fingers)):
        own, contact = slice(3 * i, 3 * i + 3), at.tool(i)
        forces, moments = wrench[:3, own], wrench[3:, own]
        assert np.allclose(moments, np.cross(contact.p, forces, axis=0))
        assert np.allclose(-contact.normal @ forces, [1, 0, 0])
        others = [f for f in range(4) if f != FINGERS.index(at.fingers[i])]
        assert not torque.reshape(4, 3, -1)[others, :, own].any()
    along, across = np.cos(at.turn), np.sin(at.turn)
    assert np.allclose(tip, [across, -along, 0, 0, 0, -80])


def test_tip_force_is_against_the_turning_about_any_pivot():
    """At the tip, against its velocity, of size 1."""
    turning = Turning(axis=(0.0, 1.0, 1.0), pivot_mm=(5.0, 3.0, 0.0))
    frame: Frame = turned_tool(turning, 0.4)
    wrench = np.array(ca.DM(tip_wrench(TOOL, turning, frame))).ravel()
    tips = [
        np.array(ca.DM(turned_tool(turning, 0.4 + step).point(ca.DM([80, 0, 0])))).ravel()
        for step in (-1e-6, 0, 1e-6)
    ]
    velocity = (tips[2] - tips[0]) / 2e-6
    assert np.allclose(wrench[:3], -velocity / np.linalg.norm(velocity), atol=1e-8)
    assert np.allclose(wrench[3:], np.cross(tips[1], wrench[:3]))
