"""Random candidates of a build, judged by formulas that share nothing with the package's."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pyarrow.parquet as pq
from numpy.typing import NDArray
from ruamel.yaml import YAML
from scipy.optimize import linprog
from scipy.spatial import KDTree

from benchmarks.paper.plain_hand import FINGERS, Posture, gap, separations

Array = NDArray[np.float64]

SEED = 11
JOINTS = ("mcp_flex", "mcp_abd", "ip_flex")
HAND = ("hand_x_mm", "hand_y_mm", "hand_z_mm", "hand_roll_rad", "hand_pitch_rad", "hand_yaw_rad")
CONTACT = ("tool_axial_mm", "tool_angle_rad", "arclength_mm", "finger_angle_rad")


class Limit(NamedTuple):
    """What a measure may be, and what it means."""

    most: float
    meaning: str


LIMITS = {
    "position": Limit(1e-6, "distance of the two contact points [mm]"),
    "normals": Limit(1e-8, "length of the sum of the two contact normals"),
    "touch": Limit(1e-6, "gap of touching solids without charts, either sign [mm]"),
    "overlap": Limit(1e-6, "overlap of solids that must stay apart [mm]"),
    "bounds": Limit(1e-6, "excess over windows, joint limits and hand bounds [mm, rad]"),
    "skin": Limit(1e-6, "excess of contacts over the skin's edges [mm]"),
    # Both linear programs keep their constraints to about 1e-6 only.
    "torque": Limit(1.0 + 1e-6, "least largest joint torque, both directions, over its cap"),
}


@dataclass(frozen=True)
class Recheck:
    """Worst value of each measure, and how many poses keep its limit."""

    hands: int
    poses: int
    worst: dict[str, float]
    within: dict[str, int]
    spacing: float
    """Least distance of two candidates of the build, over the prescribed one."""

    @property
    def all_within(self) -> bool:
        return all(kept == self.poses for kept in self.within.values())


def recheck(build: Path, count: int) -> Recheck:
    """Measure `count` random candidates of a build, all where there are fewer."""
    spec = YAML(typ="safe").load(build / "spec.yaml")
    rows = pq.read_table(build / "candidates.parquet").to_pylist()
    measured = [measures(p) for row in chosen(rows, count) for p in postures(spec, row)]
    values = {name: np.array([m[name] for m in measured]) for name in LIMITS}
    return Recheck(
        hands=min(count, len(rows)),
        poses=len(measured),
        worst={name: float(value.max()) for name, value in values.items()},
        within={name: int((value <= LIMITS[name].most).sum()) for name, value in values.items()},
        spacing=_spacing(spec, rows),
    )


def chosen(rows: list[dict[str, Any]], count: int) -> list[dict[str, Any]]:
    """A random sample without repetition, in order."""
    places = np.random.default_rng(SEED).permutation(len(rows))[:count]
    return [rows[place] for place in sorted(places)]


def postures(spec: Mapping[str, Any], row: Mapping[str, Any]) -> Iterator[Posture]:
    """A candidate's poses from its row of candidates.parquet."""
    d = np.array([_radians(name, row[name]) for name in spec["hand"]["parameters"]])
    for pose, told in spec["poses"].items():
        n = len(told["contacts"])
        yield Posture(
            spec,
            pose,
            d,
            h=np.array([row[f"{pose}.{name}"] for name in HAND]),
            u=np.array([[row[f"{pose}.{f}_{j}_rad"] for j in JOINTS] for f in FINGERS]),
            a=np.array([[row[f"{pose}.contact{i}_{c}"] for c in CONTACT] for i in range(n)]),
        )


def measures(posture: Posture) -> dict[str, float]:
    """The largest value of each measure at one pose."""
    places = range(len(posture.contacts))
    tools = [posture.on_tool(i) for i in places]
    fingers = [posture.on_finger(i) for i in places]
    pairs = list(zip(tools, fingers, strict=True))
    touching = [posture.link_capsule(c["finger"], c["link"]) for c in posture.contacts]
    return {
        "position": max(float(np.linalg.norm(t.p - f.p)) for t, f in pairs),
        "normals": max(float(np.linalg.norm(t.normal + f.normal)) for t, f in pairs),
        "touch": max(abs(gap(posture.tool, link)) for link in touching),
        "overlap": -min(separations(posture).values()),
        "bounds": max(_bound_excesses(posture)),
        "skin": max(_skin_excess(posture, i) for i in places),
        "torque": max(least_torque_share(posture, sign) for sign in (1.0, -1.0)),
    }


def _bound_excesses(posture: Posture) -> Iterator[float]:
    bounds, limits = posture.spec["bounds"], posture.spec["hand"]["joint_limits_deg"]
    yield float(np.abs(posture.h[:3]).max() - bounds["hand_position_mm"])
    yield float(np.abs(posture.h[3:]).max() - np.radians(bounds["hand_rotation_deg"]))
    for place, joint in enumerate(JOINTS):
        yield _excess(posture.u[:, place], np.radians(limits[joint]))
    for contact, (axial, angle, _, phi) in zip(posture.contacts, posture.a, strict=True):
        yield _excess(axial, contact["axial_mm"])
        yield _excess(angle, np.radians(contact["angle_deg"]))
        yield abs(phi) - float(np.radians(bounds["finger_angle_deg"]))


def _skin_excess(posture: Posture, contact: int) -> float:
    """How far a contact lies beyond the skin that its link has, less the edge [mm]."""
    spec, r = posture.spec, posture.radius
    told, (s, phi) = posture.contacts[contact], posture.a[contact, 2:]
    edge, bend_limit = spec["bounds"]["skin_edge_mm"], spec["hand"]["joint_limits_deg"]["ip_flex"]
    bend = r * max(float(np.cos(phi)), 0.0) * np.tan(np.radians(bend_limit[1]) / 2) + edge
    if told["link"] == "distal":
        ends = bend, posture.d[0] - r + spec["bounds"]["apex_fraction"] * r * np.pi / 2
    else:
        spheres = [p["radius_mm"] for p in spec["hand"]["palm"] if p["kind"] == "sphere"]
        ends = max(spheres, default=0.0) + edge, posture.proximal_length - bend
    return _excess(s, ends)


def least_torque_share(posture: Posture, sign: float) -> float:
    """Least largest joint torque against the tip force, over its cap; infinite where nothing holds.

    minimize t  subject to  W f = -w_tip, |T f| <= t, f >= 0, by HiGHS.
    """
    statics = posture.spec["statics"]
    wrench, torque = _edges(posture)
    n = wrench.shape[1]
    column = np.ones((len(torque), 1))
    rows = np.vstack([np.hstack([torque, -column]), np.hstack([-torque, -column])])
    balance = np.hstack([wrench, np.zeros((6, 1))])
    solved = linprog(
        np.append(np.zeros(n), 1.0), rows, np.zeros(len(rows)), balance, -sign * _tip_load(posture)
    )
    return float(solved.x[-1]) / statics["max_joint_torque_nmm"] if solved.success else np.inf


def _edges(posture: Posture) -> tuple[Array, Array]:
    """Wrenches (6, k) and joint torques (12, k) of unit forces along all cones' edges."""
    statics = posture.spec["statics"]
    angles = 2 * np.pi * np.arange(statics["cone_facets"]) / statics["cone_facets"]
    wrenches, torques = [], []
    for i, contact in enumerate(posture.contacts):
        point = posture.on_tool(i)
        along = np.array([1.0, 0.0, 0.0])
        around = np.cross(along, point.normal)
        axes, origins = posture.joint_axes(contact["finger"])
        first = 3 * FINGERS.index(contact["finger"])
        for angle in angles:
            tangent = np.cos(angle) * along + np.sin(angle) * around
            force = statics["friction"] * tangent - point.normal
            wrenches.append(np.concatenate([force, np.cross(point.p, force)]))
            torque = np.zeros(3 * len(FINGERS))
            levers = point.p - origins
            if contact["link"] == "distal":
                torque[first : first + 3] = np.cross(axes, levers) @ force
            else:
                torque[first : first + 2] = (np.cross(axes, levers) @ force)[:2]
            torques.append(torque)
    return np.array(wrenches).T, np.array(torques).T


def _tip_load(posture: Posture) -> Array:
    """Wrench (6,) of the tip force against positive turning [N, N mm]."""
    pose = posture.spec["poses"][posture.pose]
    tip = np.array([posture.spec["tool"]["tip_mm"], 0.0, 0.0])
    sweep = np.cross(pose["turning"]["axis"], tip - np.array(pose["turning"]["pivot_mm"]))
    force = -pose["tip_force_n"] * sweep / np.linalg.norm(sweep)
    return np.concatenate([force, np.cross(tip, force)])


def _spacing(spec: Mapping[str, Any], rows: list[dict[str, Any]]) -> float:
    """Least distance of two candidates in the standardized space, over the prescribed one."""
    free = {n: p for n, p in spec["hand"]["parameters"].items() if p.get("value") is None}
    points = np.array(
        [[(row[n] - p["min"]) / (p["max"] - p["min"]) for n, p in free.items()] for row in rows]
    )
    distances, _ = KDTree(points).query(points, k=2)
    return float(distances[:, 1].min() / spec["sampling"]["min_distance"])


def _excess(value: Array | float, limits: Any) -> float:
    """How far values lie outside an interval; negative inside."""
    low, high = limits
    return float(np.max(np.maximum(low - np.asarray(value), np.asarray(value) - high)))


def _radians(name: str, value: float) -> float:
    return float(np.radians(value)) if name.endswith("_deg") else value
