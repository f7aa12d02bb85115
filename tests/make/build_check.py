"""A build checked from its files alone: URDF and trajectories. Imports nothing from fpcad.

Lengths are in m as in the files; messages give mm. A capsule in a URDF is a cylinder with a sphere
at its ends, so that a link's surface is that of its primitives together.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import coal  # pyright: ignore[reportMissingImports]
import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports]
from numpy.typing import NDArray

Array = NDArray[np.float64]

TOUCH_M = 1e-5
"""Largest gap, and largest penetration, that counts as touching."""
NORMALS = 1e-6
"""Largest deviation of opposed unit normals' product from -1 [-]."""
LIMIT_RAD = 2e-6
"""Solvers keep joint limits to 1e-6 rad, and files to no less than that."""
REST = 1e-9
"""Largest velocity [rad/s] and acceleration [rad/s^2] at rest."""
POSE = 1e-9
"""Largest disagreement of the tool's pose and its angle [rad]."""


@dataclass
class BuildCheck:
    """What is wrong with a build, and the worst figures of each trajectory."""

    violations: list[str] = field(default_factory=list)
    figures: dict[str, dict[str, float]] = field(default_factory=dict)


def check_build(folder: Path) -> BuildCheck:
    """Check all trajectories of a build folder against its URDF."""
    check = BuildCheck()
    hands, files = sorted(folder.glob("hand/urdf/*.urdf")), sorted(folder.glob("trajectories/*"))
    if len(hands) != 1 or not files:
        check.violations.append(f"{folder}: {len(hands)} URDF and {len(files)} trajectories")
        return check
    hand = Hand(hands[0])
    for file in files:
        trial = Trial(file.stem, hand, json.loads(file.read_text(encoding="utf-8")))
        trial.run()
        check.violations += trial.violations
        check.figures[file.stem] = trial.figures
    return check


class Hand:
    """Joints and collision primitives of a URDF."""

    def __init__(self, urdf: Path) -> None:
        self.model = pin.buildModelFromUrdf(str(urdf))
        self.data = self.model.createData()
        self.shapes = pin.buildGeomFromUrdf(self.model, str(urdf), pin.GeometryType.COLLISION)
        self.placed = self.shapes.createData()

    def columns(self, names: list[str]) -> list[int]:
        """Where each named joint stands in the model's position vector."""
        return [self.model.joints[self.model.getJointId(name)].idx_q for name in names]

    def primitives(self, joints: Array) -> list[tuple[str, Any, pin.SE3]]:
        """Link, shape and pose of each collision primitive."""
        pin.updateGeometryPlacements(self.model, self.data, self.shapes, self.placed, joints)
        links = [self.model.frames[o.parentFrame].name for o in self.shapes.geometryObjects]
        shapes = [o.geometry for o in self.shapes.geometryObjects]
        return list(zip(links, shapes, self.placed.oMg, strict=True))


class Tool:
    """The cylinder at one instant."""

    def __init__(self, document: dict[str, Any], pose: pin.SE3) -> None:
        back, tip = document["back_m"], document["tip_m"]
        self.radius, self.pose = document["radius_m"], pose
        self.start, self.end = pose.act(np.array([back, 0, 0])), pose.act(np.array([tip, 0, 0]))
        to_x = np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]], dtype=float)
        middle = pin.SE3(to_x, np.array([(back + tip) / 2, 0, 0]))
        self.shape, self.shape_pose = coal.Cylinder(self.radius, tip - back), pose * middle

    def distance(self, shape: Any, pose: pin.SE3) -> float:
        """Distance [m] to any primitive; negative where they penetrate."""
        result = coal.DistanceResult()
        placed = [coal.Transform3s(p.rotation, p.translation) for p in (pose, self.shape_pose)]
        coal.distance(shape, placed[0], self.shape, placed[1], coal.DistanceRequest(), result)
        return float(result.min_distance)

    def touch(self, shape: Any, pose: pin.SE3) -> tuple[float, float]:
        """Gap [m] and product of outward normals between the tool's side and a round primitive."""
        if isinstance(shape, coal.Sphere):
            start = end = pose.translation
        elif isinstance(shape, coal.Cylinder):
            start = pose.act(np.array([0, 0, -shape.halfLength]))
            end = pose.act(np.array([0, 0, shape.halfLength]))
        else:
            return np.inf, np.inf
        foot, tool_foot, squarely = nearest_points(start, end, self.start, self.end)
        if not squarely:  # only the flat end of a cylinder is near; a sphere covers it
            return np.inf, np.inf
        between, axis = foot - tool_foot, self.end - self.start
        radial = between - axis * (axis @ between) / (axis @ axis)
        side = tool_foot + self.radius * radial / np.linalg.norm(radial)
        outward = (side - foot) / np.linalg.norm(side - foot)
        gap = float(np.linalg.norm(between) - shape.radius - self.radius)
        return gap, float(outward @ radial / np.linalg.norm(radial))


def nearest_points(a: Array, b: Array, c: Array, d: Array) -> tuple[Array, Array, bool]:
    """Nearest points of the segment or point ab and the segment cd, and whether ab is met squarely.

    The feet of the lines' common normal are tried beside all four ends.
    """
    candidates = [(p, closest(p, c, d)) for p in (a, b)]
    candidates += [(closest(p, a, b), p) for p in (c, d)]
    u, v, w = b - a, d - c, c - a
    system = np.array([[u @ u, -u @ v], [u @ v, -v @ v]])
    if abs(np.linalg.det(system)) > 1e-12 * (u @ u) * (v @ v) > 0:
        s, t = np.linalg.solve(system, [u @ w, v @ w])
        if 0 <= s <= 1 and 0 <= t <= 1:
            candidates.append((a + s * u, c + t * v))
    p, q = min(candidates, key=lambda pair: float(np.linalg.norm(pair[0] - pair[1])))
    squarely = abs(u @ (q - p)) <= 1e-9 * np.sqrt(u @ u)
    return p, q, bool(squarely)


def closest(point: Array, start: Array, end: Array) -> Array:
    """Nearest point of a segment."""
    along = end - start
    length = along @ along
    share = 0.0 if length == 0 else np.clip((point - start) @ along / length, 0.0, 1.0)
    return start + share * along


class Trial:
    """One trajectory put to the test."""

    def __init__(self, name: str, hand: Hand, document: dict[str, Any]) -> None:
        self.name, self.hand, self.document = name, hand, document
        self.violations: list[str] = []
        self.figures: dict[str, float] = {}
        self.time = np.array(document["time_s"])
        self.knots = [
            np.array(document[key])
            for key in ("position_rad", "velocity_rad_s", "acceleration_rad_s2")
        ]
        self.poses = [se3(row) for row in document["tool"]["pose_palm"]]
        self.contacts = {f"{c['finger']}_{c['link']}" for c in document["contacts"]}

    def run(self) -> None:
        """All checks, the cheap ones first."""
        self.check_time_and_rest()
        self.check_tool_angle()
        if not self.violations:
            self.check_limits()
            self.check_contact()

    def check_time_and_rest(self) -> None:
        if self.time[0] != 0 or not np.all(np.diff(self.time) > 0):
            self.fault("time does not increase from 0")
        position, velocity, acceleration = self.knots
        for end, when in ((0, "start"), (-1, "end")):
            if max(np.abs(velocity[end]).max(), np.abs(acceleration[end]).max()) > REST:
                self.fault(f"not at rest at the {when}")
        if np.abs(position[0] - position[-1]).max() > REST:
            self.fault("does not end where it starts")

    def check_tool_angle(self) -> None:
        angles = np.array(self.document["tool"]["angle_rad"])
        if angles[0] != 0 or angles[-1] != 0:
            self.fault("the tool does not start and end at angle 0")
        turned = [pin.log3(self.poses[0].rotation.T @ pose.rotation) for pose in self.poses]
        ahead = turned[int(np.argmax(angles))] - turned[int(np.argmin(angles))]
        axis = ahead / max(np.linalg.norm(ahead), 1e-300)
        error = max(
            float(np.linalg.norm(pin.exp3(t).T @ pin.exp3(axis * a) - np.eye(3)))
            for t, a in zip(turned, angles, strict=True)
        )
        if error > POSE:
            self.fault(f"the tool's poses and angles differ by {error:.2g} rad")

    def check_limits(self) -> None:
        columns = self.hand.columns(self.document["joint_names"])
        model = self.hand.model
        low, high = model.lowerPositionLimit[columns], model.upperPositionLimit[columns]
        fastest = model.velocityLimit[columns]
        for share in np.linspace(0.0, 1.0, 9):
            position, velocity = self.between(share)
            self.worst("joint beyond its limit [rad]", np.maximum(low - position, position - high))
            self.worst("speed beyond its limit [rad/s]", np.abs(velocity) - fastest)
        if self.figures["joint beyond its limit [rad]"] > LIMIT_RAD:
            self.fault(
                f"joint limit passed by {self.figures['joint beyond its limit [rad]']:.3g} rad"
            )
        if self.figures["speed beyond its limit [rad/s]"] > REST:
            excess = self.figures["speed beyond its limit [rad/s]"]
            self.fault(f"velocity limit passed by {excess:.3g} rad/s")

    def check_contact(self) -> None:
        columns = self.hand.columns(self.document["joint_names"])
        for share, where in ((0.0, "knots"), (0.5, "midpoints"), (1.0, "knots")):
            positions = self.between(share)[0]
            times = self.time[:-1] + share * np.diff(self.time)
            for k in range(len(times)) if share < 1.0 else [len(times) - 1]:
                joints = np.zeros(self.hand.model.nq)
                joints[columns] = positions[k]
                pose = pin.SE3.Interpolate(self.poses[k], self.poses[k + 1], share)
                tool = Tool(self.document["tool"], pose)
                self.check_instant(joints, tool, where, float(times[k]))

    def check_instant(self, joints: Array, tool: Tool, where: str, time: float) -> None:
        primitives = self.hand.primitives(joints)
        for link in sorted(self.contacts):
            touches = [tool.touch(shape, pose) for name, shape, pose in primitives if name == link]
            gap, product = min(touches, default=(np.inf, np.inf))
            self.worst(f"gap at {where} [mm]", 1e3 * abs(gap))
            self.worst("normals from opposed [-]", 1 + product)
            if abs(gap) > TOUCH_M:
                self.fault(f"{link} is {1e3 * gap:.4f} mm off the tool at {time:.3f} s ({where})")
            elif 1 + product > NORMALS:
                self.fault(f"{link} meets the tool askew at {time:.3f} s ({where})")
        for link, shape, pose in primitives:
            if link not in self.contacts:
                depth = -tool.distance(shape, pose)
                self.worst("penetration [mm]", 1e3 * depth)
                if depth > TOUCH_M:
                    self.fault(f"{link} is {1e3 * depth:.4f} mm inside the tool at {time:.3f} s")

    def between(self, share: float) -> tuple[Array, Array]:
        """Positions and velocities (N - 1, n) at a share of each segment, by quintic Hermite."""
        p, v, a = self.knots
        h, s = np.diff(self.time)[:, None], share
        d = p[1:] - p[:-1] - h * v[:-1] - h**2 * a[:-1] / 2
        e = h * (v[1:] - v[:-1]) - h**2 * a[:-1]
        f = h**2 * (a[1:] - a[:-1])
        c3, c4, c5 = 10 * d - 4 * e + f / 2, -15 * d + 7 * e - f, 6 * d - 3 * e + f / 2
        start = p[:-1] + s * h * v[:-1] + (s * h) ** 2 * a[:-1] / 2
        rate = v[:-1] + s * h * a[:-1] + (3 * c3 * s**2 + 4 * c4 * s**3 + 5 * c5 * s**4) / h
        return start + c3 * s**3 + c4 * s**4 + c5 * s**5, rate

    def worst(self, figure: str, values: Any) -> None:
        self.figures[figure] = max(self.figures.get(figure, -np.inf), float(np.max(values)))

    def fault(self, text: str) -> None:
        self.violations.append(f"{self.name}: {text}")


def se3(row: list[float]) -> pin.SE3:
    """Pose from xyz and quaternion w x y z."""
    x, y, z, qw, qx, qy, qz = row
    return pin.SE3(pin.Quaternion(qw, qx, qy, qz).matrix(), np.array([x, y, z]))
