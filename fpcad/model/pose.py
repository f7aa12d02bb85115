"""The symbolic model of one pose: tool and hand in contact. Everything else is derived from it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from fpcad.model.collision import Pair, collision_pairs, link_bodies
from fpcad.model.contact import (
    NORMAL_SCALE_MM,
    ContactRates,
    RelativeMotion,
    contact_rates,
    contact_residual,
    contact_rows,
    opposition,
)
from fpcad.model.cost import cost_residuals
from fpcad.model.distance import Segment
from fpcad.model.frames import Expr, Frame, rot_rpy
from fpcad.model.hand import LinkShape, hand_template
from fpcad.model.statics import UnitForces, cone_axes, tip_wrench, unit_forces
from fpcad.model.surfaces import SurfacePoint, capsule_point, cylinder_point, turned_tool
from fpcad.spec.schema import Spec
from fpcad.units import RAD_PER_DEG

Array = NDArray[np.float64]
HAND_SIZE = 6
CONTACT_SIZE = 4


@dataclass(frozen=True)
class StateLayout:
    """Where hand pose, joints and contacts lie in a pose's state vector y = [h, u, a]."""

    n_fingers: int
    n_joints: int
    """Joints of one finger."""
    n_contacts: int

    @property
    def n_u(self) -> int:
        return self.n_fingers * self.n_joints

    @property
    def size(self) -> int:
        return HAND_SIZE + self.n_u + CONTACT_SIZE * self.n_contacts

    @property
    def hand(self) -> slice:
        """Position xyz [mm] and roll, pitch, yaw [rad] of H in O."""
        return slice(0, HAND_SIZE)

    @property
    def joints(self) -> slice:
        """Joint angles [rad], finger by finger."""
        return slice(HAND_SIZE, HAND_SIZE + self.n_u)

    @property
    def contacts(self) -> slice:
        """Tool axial [mm], tool angle [rad], arc length [mm], finger angle [rad] per contact."""
        return slice(HAND_SIZE + self.n_u, self.size)

    @property
    def scale(self) -> Array:
        """(size,) units of the solvers' variables: 10 mm counts as 1 rad."""
        contact = [10.0, 1.0, 10.0, 1.0] * self.n_contacts
        return np.array([10.0] * 3 + [1.0] * 3 + [1.0] * self.n_u + contact)


class PoseModel:
    """Symbols and expressions of one pose of a spec. Lengths in mm, angles in rad.

    Attributes:
        d: design vector (n_d,).
        h: hand pose (6,), theta_h of the paper.
        turn: tool angle u_t.
        u: joint angles of all fingers (n_u,).
        a: contact coordinates (4 n,), a_t and a_f of the paper for each contact.
    """

    def __init__(self, spec: Spec, name: str) -> None:
        self.spec, self.name, self.pose = spec, name, spec.poses[name]
        self.template = hand_template(spec.hand)
        names = self.template.names
        self.layout = StateLayout(len(names.fingers), len(names.joints), len(self.pose.contacts))
        self.d = ca.SX.sym("d", len(names.parameters))
        self.h = ca.SX.sym("h", HAND_SIZE)
        self.turn = ca.SX.sym("turn")
        self.u = ca.SX.sym("u", self.layout.n_u)
        self.a = ca.SX.sym("a", CONTACT_SIZE * self.layout.n_contacts)

    @property
    def y(self) -> Expr:
        """State vector [h, u, a] (layout.size,)."""
        return ca.vertcat(self.h, self.u, self.a)

    @cached_property
    def hand_frame(self) -> Frame:
        """H in O."""
        return Frame(rot_rpy(self.h[3], self.h[4], self.h[5]), self.h[:3])

    @cached_property
    def link_frames(self) -> dict[str, dict[str, Frame]]:
        """Each finger's links in H."""
        n = self.layout.n_joints
        return {
            finger: self.template.link_frames(finger, self.d, self.u[i * n : (i + 1) * n])
            for i, finger in enumerate(self.template.names.fingers)
        }

    @cached_property
    def tool_frame(self) -> Frame:
        """The turned tool in O."""
        return turned_tool(self.pose.turning, self.turn)

    def contact_coordinates(self, index: int) -> Expr:
        """(4,) coordinates of one contact."""
        return self.a[CONTACT_SIZE * index : CONTACT_SIZE * (index + 1)]

    @cached_property
    def contact_pairs(self) -> list[tuple[SurfacePoint, SurfacePoint]]:
        """Tool's and finger's surface point of each contact, in O."""
        pairs = []
        for i, contact in enumerate(self.pose.contacts):
            axial, angle, s, phi = ca.vertsplit(self.contact_coordinates(i))
            shape = self.template.link_shape(contact.link, self.d)
            link = self.hand_frame @ self.link_frames[contact.finger][contact.link]
            tool = cylinder_point(self.spec.tool, axial, angle).moved(self.tool_frame)
            pairs.append((tool, capsule_point(shape, s, phi).moved(link)))
        return pairs

    def rows(self) -> Expr:
        """Contact constraint (5 n,) [mm]."""
        return ca.vertcat(*[contact_rows(t, f) for t, f in self.contact_pairs])

    def residual(self) -> Expr:
        """The paper's six equations a contact (6 n,) [mm, -]."""
        return ca.vertcat(*[contact_residual(t, f) for t, f in self.contact_pairs])

    def opposition_margin(self) -> Expr:
        """(n,) >= 0 on the right branch of the contact rows."""
        least = self.spec.bounds.opposition
        return ca.vertcat(*[opposition(t, f) - least for t, f in self.contact_pairs])

    def skin_margin(self) -> Expr:
        """Distances [mm] that contacts keep from the ends of the links' skins, >= 0."""
        margins = []
        for i, contact in enumerate(self.pose.contacts):
            _, _, s, phi = ca.vertsplit(self.contact_coordinates(i))
            margins += self._skin_ends(self.template.link_shape(contact.link, self.d), s, phi)
        return ca.vertcat(*margins)

    def _skin_ends(self, shape: LinkShape, s: Expr, phi: Expr) -> list[Expr]:
        edge, r = self.spec.bounds.skin_edge_mm, shape.radius
        bend = r * ca.fmax(ca.cos(phi), 0) * np.tan(self.template.bend_limit / 2) + edge
        apex = shape.axis_length + self.spec.bounds.apex_fraction * r * np.pi / 2
        start = bend if shape.bends_at_start else shape.hidden_start + edge
        end = apex if shape.has_tip else shape.axis_length - (bend if shape.bends_at_end else edge)
        return [s - start, end - s]

    @cached_property
    def collision_pairs(self) -> list[Pair]:
        """All pairs of solids that must stay apart, in H."""
        to_hand = Frame(self.hand_frame.R.T, -self.hand_frame.R.T @ self.hand_frame.p)
        tool = to_hand @ self.tool_frame
        ends = (
            tool.point(ca.DM([x, 0, 0])) for x in (self.spec.tool.back_mm, self.spec.tool.tip_mm)
        )
        touching = {(c.finger, c.link) for c in self.pose.contacts}
        bodies = link_bodies(self.template, self.d, self.link_frames)
        palm, radius = self.template.palm(self.d), self.spec.tool.radius_mm
        return list(collision_pairs(bodies, palm, Segment(*ends), radius, touching))

    def collision_margin(self) -> Expr:
        """Smooth margins [mm] of all collision pairs, >= 0."""
        return ca.vertcat(*[pair.margin() for pair in self.collision_pairs])

    def margins(self) -> Expr:
        """All margins >= 0; the opposition counts in mm like a deviation of normals."""
        opposition = NORMAL_SCALE_MM * self.opposition_margin()
        return ca.vertcat(opposition, self.skin_margin(), self.collision_margin())

    def clearances(self) -> Expr:
        """Gaps [mm] of all collision pairs."""
        return ca.vertcat(*[pair.clearance() for pair in self.collision_pairs])

    def cost(self) -> Expr:
        """Residuals whose sum of squares is the sampling cost."""
        rest = [self.spec.hand.rest_posture_deg.get(j, 0.0) for j in self.template.names.joints]
        normals: dict[str, list[Expr]] = {c.finger: [] for c in self.pose.contacts}
        for contact, (_, finger) in zip(self.pose.contacts, self.contact_pairs, strict=True):
            normals[contact.finger].append(finger.normal)
        return cost_residuals(
            self.pose, self.template.names, normals, self.u, np.array(rest) * RAD_PER_DEG
        )

    def relative_motions(self, u_rate: Expr, turn_rate: Expr) -> list[RelativeMotion]:
        """Motion of finger against tool at each contact, for joint and tool rates.

        A chart point with fixed coordinates is a material point, so its derivative is a velocity.
        """
        motions = []
        for tool, finger in self.contact_pairs:
            v = ca.jtimes(finger.p, self.u, u_rate) - ca.jtimes(tool.p, self.turn, turn_rate)
            spin = -ca.jtimes(finger.normal, self.u, u_rate) - ca.jtimes(
                tool.normal, self.turn, turn_rate
            )
            E = tool.tangents
            motions.append(RelativeMotion(E.T @ v, ca.dot(tool.normal, v), E.T @ spin))
        return motions

    def contact_rates(self, motions: list[RelativeMotion]) -> list[ContactRates]:
        """Rates of the contact coordinates that keep contact, for given relative motions."""
        return [
            contact_rates(t, f, m) for (t, f), m in zip(self.contact_pairs, motions, strict=True)
        ]

    def cone_axes(self) -> UnitForces:
        """Wrenches (6, 3 n) and joint torques (n_u, 3 n) of normal forces and friction."""
        parts = [
            unit_forces(cone_axes(self.spec.statics, tool), tool, ca.jacobian(finger.p, self.u))
            for tool, finger in self.contact_pairs
        ]
        return UnitForces(
            ca.horzcat(*[p.wrench for p in parts]), ca.horzcat(*[p.torque for p in parts])
        )

    def tip_wrench(self) -> Expr:
        """Wrench (6,) on the tool of a unit force at its tip against positive turning."""
        return tip_wrench(self.spec.tool, self.pose.turning, self.tool_frame)
