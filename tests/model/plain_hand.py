"""The hand and the tool a second time, in plain NumPy: what the symbolic model is held against."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]

FINGERS = ("thumb", "index", "middle", "ring")
FINGER_LENGTH_MM = 100.0
TOOL_RADIUS_MM = 6.0


class Rigid(NamedTuple):
    """A frame seen from another one."""

    R: Array  # (3, 3)
    p: Array  # (3,) [mm]

    def __matmul__(self, child: Rigid) -> Rigid:  # type: ignore[override]
        return Rigid(self.R @ child.R, self.p + self.R @ child.p)


class Touch(NamedTuple):
    """A point of a surface with its outward normal and the tangents along both coordinates."""

    p: Array  # (3,) [mm]
    normal: Array  # (3,)
    tangents: Array  # (3, 2)

    def seen_from(self, frame: Rigid) -> Touch:
        """The same point in the parent of `frame`."""
        return Touch(frame.p + frame.R @ self.p, frame.R @ self.normal, frame.R @ self.tangents)


def about(axis: str, angle: float) -> Array:
    """Rotation (3, 3) about a coordinate axis."""
    return Rotation.from_euler(axis, angle).as_matrix()


def hand_frame(h: Array) -> Rigid:
    """H in O, from xyz [mm] and roll, pitch, yaw [rad]."""
    return Rigid(Rotation.from_euler("xyz", h[3:]).as_matrix(), h[:3])


def root_frame(finger: str, d: Array) -> Rigid:
    """A finger's root in H."""
    _, d2, d3, _, d5, d6 = d
    if finger == "thumb":
        R = about("z", np.pi) @ about("y", d5) @ about("x", d6)
        return Rigid(R, np.array([-d2 / 2, 0.0, 0.0]))
    y = {"index": d3, "middle": 0.0, "ring": -d3}[finger]
    return Rigid(about("y", d5), np.array([d2 / 2, y, 0.0]))


def link_frame(finger: str, link: str, d: Array, u: Array) -> Rigid:
    """A link in H, for the finger's three joint angles [rad]."""
    here = np.zeros(3)
    proximal = root_frame(finger, d) @ Rigid(about("y", u[0]), here) @ Rigid(about("z", u[1]), here)
    if link == "proximal":
        return proximal
    return proximal @ Rigid(about("y", u[2]), np.array([FINGER_LENGTH_MM - d[0], 0.0, 0.0]))


def distal_touch(d: Array, s: float, phi: float) -> Touch:
    """Point of a distal link's skin in the link's frame, at arc length [mm] and angle [rad]."""
    r = d[3] / 2
    cylinder = d[0] - r
    t = max(s - cylinder, 0.0) / r
    radial = np.array([0.0, np.sin(phi), -np.cos(phi)])
    ahead = np.array([1.0, 0.0, 0.0])
    normal = np.sin(t) * ahead + np.cos(t) * radial
    around = np.array([0.0, np.cos(phi), np.sin(phi)])
    along = np.cos(t) * ahead - np.sin(t) * radial
    return Touch(min(s, cylinder) * ahead + r * normal, normal, np.stack([along, around], axis=1))


def tool_touch(turn: float, axial: float, angle: float) -> Touch:
    """Point of the tool in O, turned about z."""
    normal = np.array([0.0, np.cos(angle), np.sin(angle)])
    ahead = np.array([1.0, 0.0, 0.0])
    around = np.array([0.0, -np.sin(angle), np.cos(angle)])
    point = Touch(
        axial * ahead + TOOL_RADIUS_MM * normal, normal, np.stack([ahead, around], axis=1)
    )
    return point.seen_from(Rigid(about("z", turn), np.zeros(3)))


class Posture(NamedTuple):
    """All variables of one pose: design, tool angle, hand pose, joints and contacts."""

    fingers: tuple[str, ...]  # of the contacts, each on a distal link
    d: Array  # (6,) [mm, rad]
    turn: float  # [rad]
    h: Array  # (6,) [mm, rad]
    u: Array  # (4, 3) [rad]
    a: Array  # (n, 4) tool axial [mm], tool angle [rad], arc length [mm], finger angle [rad]

    @property
    def y(self) -> Array:
        """State vector [h, u, a]."""
        return np.concatenate([self.h, self.x])

    @property
    def x(self) -> Array:
        """State vector [u, a]."""
        return np.concatenate([self.u.ravel(), self.a.ravel()])

    def tool(self, i: int) -> Touch:
        """Contact `i` on the tool, in O."""
        return tool_touch(self.turn, self.a[i, 0], self.a[i, 1])

    def finger(self, i: int) -> Touch:
        """Contact `i` on its finger, in O."""
        name = self.fingers[i]
        link = link_frame(name, "distal", self.d, self.u[FINGERS.index(name)])
        return distal_touch(self.d, self.a[i, 2], self.a[i, 3]).seen_from(hand_frame(self.h) @ link)
