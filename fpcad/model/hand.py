"""Hand templates: from design parameters and joint angles to frames of links and palm."""

from __future__ import annotations

from typing import NamedTuple, Protocol

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from fpcad.model.frames import Expr, Frame, rot_x, rot_y, rot_z
from fpcad.spec.hand import Hand, PalmCapsule, PalmSphere
from fpcad.spec.templates import TEMPLATES, TemplateNames
from fpcad.units import RAD_PER_DEG


class LinkShape(NamedTuple):
    """A link's contact capsule; its axis is x of the link's frame, from the proximal joint."""

    axis_length: Expr  # [mm] from the proximal joint to where the cylinder ends
    radius: Expr  # [mm]
    has_tip: bool  # a hemisphere that a tool may touch lies beyond the cylinder
    bends_at_start: bool  # the skin is cut to the bend plane of the IP joint at the start
    bends_at_end: bool  # ... at the end of the cylinder
    hidden_start: float  # [mm] of the axis inside the palm's solid that the finger roots in


class PalmSolid(NamedTuple):
    """A capsule of the palm in H; a sphere has equal ends."""

    name: str
    start: Expr  # (3, 1) [mm]
    end: Expr  # (3, 1) [mm]
    radius: float  # [mm]
    exempt_finger: str | None  # the finger that roots in this solid


class HandTemplate(Protocol):
    """What the rest of the model asks of a hand. All lengths in mm, angles in rad."""

    names: TemplateNames
    spec: Hand

    def feasible(self, d: NDArray[np.float64]) -> bool:
        """Whether a design (n_d,) makes geometrical sense before any pose is solved."""
        ...

    def root_frame(self, finger: str, d: Expr) -> Frame:
        """Frame of a finger's root in H, x along the straight finger."""
        ...

    def link_frames(self, finger: str, d: Expr, u: Expr) -> dict[str, Frame]:
        """Frame of each link in H for joint angles u (n_joints,) [rad]."""
        ...

    def link_shape(self, link: str, d: Expr) -> LinkShape:
        """Contact capsule of a link, the same for all fingers."""
        ...

    @property
    def bend_limit(self) -> float:
        """Largest bend [rad] of the joint between two links, to whose plane the skins are cut."""
        ...

    def palm(self, d: Expr) -> list[PalmSolid]:
        """The palm's primitives in H."""
        ...


class AnthropomorphicHand:
    """Four identical 3-DoF fingers: thumb against index, middle and ring. docs/model.md, Hand."""

    names = TEMPLATES["anthropomorphic_4f"]

    def __init__(self, spec: Hand) -> None:
        self.spec = spec

    def feasible(self, d: NDArray[np.float64]) -> bool:
        """Roots do not overlap and both links are longer than their caps."""
        d1, _, d3, d4, _, _ = d
        return bool(
            d3 >= d4 + self.spec.root_gap_mm and d4 / 2 < d1 < self.spec.finger_length_mm - d4 / 2
        )

    def root_frame(self, finger: str, d: Expr) -> Frame:
        _, d2, d3, _, d5, d6 = (d[i] for i in range(6))
        if finger == "thumb":
            return Frame(rot_z(np.pi) @ rot_y(d5) @ rot_x(d6), ca.vertcat(-d2 / 2, 0, 0))
        y = {"index": d3, "middle": 0, "ring": -d3}[finger]
        return Frame(rot_y(d5), ca.vertcat(d2 / 2, y, 0))

    def link_frames(self, finger: str, d: Expr, u: Expr) -> dict[str, Frame]:
        proximal = self.root_frame(finger, d) @ Frame(rot_y(u[0]) @ rot_z(u[1]), ca.DM.zeros(3))
        ip = ca.vertcat(self.spec.finger_length_mm - d[0], 0, 0)
        return {"proximal": proximal, "distal": proximal @ Frame(rot_y(u[2]), ip)}

    def link_shape(self, link: str, d: Expr) -> LinkShape:
        radius = d[3] / 2
        if link == "distal":
            return LinkShape(d[0] - radius, radius, True, True, False, 0.0)
        hidden = max(
            (s.radius_mm for s in self.spec.palm if isinstance(s, PalmSphere)), default=0.0
        )
        length = self.spec.finger_length_mm - d[0]
        return LinkShape(length, radius, False, False, True, hidden)

    @property
    def bend_limit(self) -> float:
        return self.spec.joint_limits_deg["ip_flex"][1] * RAD_PER_DEG

    def palm(self, d: Expr) -> list[PalmSolid]:
        sites = {f"{finger}_root": self.root_frame(finger, d).p for finger in self.names.fingers}
        solids = []
        for solid in self.spec.palm:
            offset = ca.DM(solid.offset_mm)
            if isinstance(solid, PalmCapsule):
                start, end, own = sites[solid.start], sites[solid.end], None
            else:
                start = end = sites[solid.at]
                own = solid.at.removesuffix("_root")
            solids.append(PalmSolid(solid.name, start + offset, end + offset, solid.radius_mm, own))
        return solids


TEMPLATE_CLASSES: dict[str, type[AnthropomorphicHand]] = {"anthropomorphic_4f": AnthropomorphicHand}


def hand_template(spec: Hand) -> HandTemplate:
    """The kinematics of the template that a hand's spec names."""
    return TEMPLATE_CLASSES[spec.template](spec)
