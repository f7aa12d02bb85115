"""Hand, tool and poses a second time, in NumPy alone, read from a build's own spec.yaml.

Nothing here comes from fpcad: forward kinematics, surface charts, collision pairs and friction cones are
written anew from docs/model.md, so that a fault of the package's formulas cannot hide in the check.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FINGERS = ("thumb", "index", "middle", "ring")
LINKS = ("proximal", "distal")


class Capsule(NamedTuple):
    """A segment with a radius [mm]; equal ends make a sphere."""

    start: Array  # (3,)
    end: Array  # (3,)
    radius: float


class Surface(NamedTuple):
    """A surface point with its outward unit normal."""

    p: Array  # (3,) [mm]
    normal: Array  # (3,)


@dataclass(frozen=True)
class Posture:
    """One candidate at one pose; everything in O, the tool's frame. Lengths mm, angles rad."""

    spec: Mapping[str, Any]
    """spec.yaml as read."""
    pose: str
    d: Array  # (6,) design
    h: Array  # (6,) hand in O: xyz, roll, pitch, yaw
    u: Array  # (4, 3) joints
    a: Array  # (n, 4) tool axial, tool angle, arc length, finger angle

    @property
    def contacts(self) -> list[Mapping[str, Any]]:
        """The pose's contacts in the spec."""
        return self.spec["poses"][self.pose]["contacts"]

    @property
    def radius(self) -> float:
        """Radius of all finger links."""
        return float(self.d[3]) / 2

    @property
    def proximal_length(self) -> float:
        """From a finger's root to its IP axis."""
        return float(self.spec["hand"]["finger_length_mm"] - self.d[0])

    def root(self, finger: str) -> Array:
        """Homogeneous pose (4, 4) of a finger's root in H."""
        _, d2, d3, _, d5, d6 = self.d
        if finger == "thumb":
            return moved(-d2 / 2, 0, 0) @ turned(2, np.pi) @ turned(1, d5) @ turned(0, d6)
        y = {"index": d3, "middle": 0.0, "ring": -d3}[finger]
        return moved(d2 / 2, y, 0) @ turned(1, d5)

    def link(self, finger: str, link: str) -> Array:
        """Homogeneous pose (4, 4) of a link in O, x along the link."""
        flexion, abduction, bend = self.u[FINGERS.index(finger)]
        proximal = self.hand @ self.root(finger) @ turned(1, flexion) @ turned(2, abduction)
        if link == "proximal":
            return proximal
        return proximal @ moved(self.proximal_length, 0, 0) @ turned(1, bend)

    @property
    def hand(self) -> Array:
        """Homogeneous pose (4, 4) of H in O."""
        roll, pitch, yaw = self.h[3:]
        return moved(*self.h[:3]) @ turned(2, yaw) @ turned(1, pitch) @ turned(0, roll)

    def link_capsule(self, finger: str, link: str) -> Capsule:
        """A link as a solid."""
        length = self.proximal_length if link == "proximal" else self.d[0] - self.radius
        T = self.link(finger, link)
        return Capsule(T[:3, 3], T[:3, 3] + length * T[:3, 0], self.radius)

    @property
    def tool(self) -> Capsule:
        """The tool's axis with its radius, at the pose itself."""
        tool = self.spec["tool"]
        ends = np.array([[tool["back_mm"], 0.0, 0.0], [tool["tip_mm"], 0.0, 0.0]])
        return Capsule(ends[0], ends[1], tool["radius_mm"])

    def palm(self) -> dict[str, tuple[Capsule, bool]]:
        """Palm solids by name; and whether distal links must keep clear of each."""
        solids = {}
        for solid in self.spec["hand"]["palm"]:
            sphere = solid["kind"] == "sphere"
            sites = [solid["at"]] * 2 if sphere else [solid["start"], solid["end"]]
            ends = [self.root(site.removesuffix("_root"))[:3, 3] for site in sites]
            start, end = (
                self.hand[:3, :3] @ (p + np.array(solid["offset_mm"])) + self.hand[:3, 3]
                for p in ends
            )
            solids[solid["name"]] = Capsule(start, end, solid["radius_mm"]), not sphere
        return solids

    def on_tool(self, contact: int) -> Surface:
        """Contact point on the tool by its chart."""
        axial, angle = self.a[contact, :2]
        normal = np.array([0.0, np.cos(angle), np.sin(angle)])
        return Surface(np.array([axial, 0.0, 0.0]) + self.tool.radius * normal, normal)

    def on_finger(self, contact: int) -> Surface:
        """Contact point on the finger by its chart: along the capsule's profile, then about it."""
        told, (s, phi) = self.contacts[contact], self.a[contact, 2:]
        r, axis_end = self.radius, self.d[0] - self.radius
        tilt = max(s - axis_end, 0.0) / r if told["link"] == "distal" else 0.0
        about = np.array([0.0, np.sin(phi), -np.cos(phi)])
        normal = np.cos(tilt) * about + np.array([np.sin(tilt), 0.0, 0.0])
        center = np.array([s if tilt == 0.0 else axis_end, 0.0, 0.0])
        T = self.link(told["finger"], told["link"])
        return Surface(T[:3, :3] @ (center + r * normal) + T[:3, 3], T[:3, :3] @ normal)

    def joint_axes(self, finger: str) -> tuple[Array, Array]:
        """Axes (3, 3) and points on them (3, 3) of a finger's joints in O, one a row."""
        flexion = self.u[FINGERS.index(finger), 0]
        root = self.hand @ self.root(finger)
        proximal, distal = self.link(finger, "proximal"), self.link(finger, "distal")
        swung = root @ turned(1, flexion)
        axes = np.array([root[:3, 1], swung[:3, 2], proximal[:3, 1]])
        return axes, np.array([root[:3, 3], root[:3, 3], distal[:3, 3]])


def separations(posture: Posture) -> dict[str, float]:
    """Gap [mm] of each pair of solids that must not touch."""
    links = {(f, k): posture.link_capsule(f, k) for f in FINGERS for k in LINKS}
    touching = {(c["finger"], c["link"]) for c in posture.contacts}
    gaps = {f"{a}/{b}": gap(links[a], links[b]) for a, b in combinations(links, 2) if a[0] != b[0]}
    gaps |= {f"tool/{k}": gap(posture.tool, c) for k, c in links.items() if k not in touching}
    for name, (solid, for_distal) in posture.palm().items():
        gaps[f"tool/{name}"] = gap(posture.tool, solid)
        if for_distal:
            gaps |= {f"{f}/{name}": gap(links[f, "distal"], solid) for f in FINGERS}
    return gaps


def gap(a: Capsule, b: Capsule) -> float:
    """Distance of two capsules' surfaces, by alternating clamps (Ericson 2004, section 5.1.9)."""
    u, v, w = a.end - a.start, b.end - b.start, a.start - b.start
    uu, vv, uv, uw, vw = u @ u, v @ v, u @ v, u @ w, v @ w
    s = 0.0
    if uu > 0 and vv > 0:
        # The cross product keeps the digits that uu * vv - uv^2 loses for nearly parallel axes.
        sine = np.cross(u, v) @ np.cross(u, v)
        s = float(np.clip((uv * vw - vv * uw) / sine, 0.0, 1.0)) if sine > 0 else 0.0
    t = (uv * s + vw) / vv if vv > 0 else 0.0
    if not 0.0 <= t <= 1.0 or vv == 0:
        t = float(np.clip(t, 0.0, 1.0))
        s = float(np.clip((uv * t - uw) / uu, 0.0, 1.0)) if uu > 0 else 0.0
    return float(np.linalg.norm(w + s * u - t * v)) - a.radius - b.radius


def moved(x: float, y: float, z: float) -> Array:
    """Translation (4, 4)."""
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T


def turned(axis: int, angle: float) -> Array:
    """Right-handed rotation (4, 4) about coordinate axis 0, 1 or 2."""
    T, (i, j) = np.eye(4), [(1, 2), (2, 0), (0, 1)][axis]
    c, s = np.cos(angle), np.sin(angle)
    T[i, i], T[i, j], T[j, i], T[j, j] = c, -s, s, c
    return T
