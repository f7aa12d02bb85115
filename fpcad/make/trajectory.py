"""Joint trajectories that turn the tool along a wielding path; docs/trajectories.md."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BPoly

from fpcad.errors import MakeError
from fpcad.make.grip import ContactLink, Grip
from fpcad.make.limits import joint_ranges, motion_limits
from fpcad.make.quintic import Motion, MotionLimits, Offset, pressure, quintics, slowed
from fpcad.make.refine import ContactCurve, Leg, Project, contact_curve, legs, limit_excess
from fpcad.make.timing import TimeLaw, clock_cells, fastest_law
from fpcad.model.geometry import HandGeometry
from fpcad.spec.schema import Spec
from fpcad.spec.templates import TEMPLATES
from fpcad.units import M_PER_MM
from fpcad.wield.path import WieldingPath

Array = NDArray[np.float64]

FILE_GAP_MM = 0.006
"""Gap between knots beyond which another knot is put between them."""
LIMIT_EXCESS_RAD = 5e-7
"""Overshoot of a joint limit beyond which another knot is put between two."""
MAX_SPLITS = 14
"""How often the time between two knots may be halved."""
SLOWING_ROUNDS = 4
"""How often cells are slowed; what then remains slows the whole leg."""
PRESSURE_TOLERANCE = 0.005
"""Excess over the limits [-] that slowing the whole leg makes up for."""
REST_S = 1.0
"""Duration of a trajectory that has nowhere to go."""


@dataclass(frozen=True)
class ToolMotion:
    """The tool and where it is in `palm` at each knot. SI units."""

    radius_m: float
    back_m: float
    tip_m: float
    angle_rad: Array
    """(N,) turn from the pose."""
    pose_palm: Array
    """(N, 7): xyz [m] and quaternion w x y z of O, turned."""


@dataclass(frozen=True)
class Trajectory:
    """Knots of quintic Hermite splines over time. SI units."""

    joint_names: tuple[str, ...]
    time_s: Array
    """(N,) strictly increasing from 0."""
    position_rad: Array
    """(N, n_joints)"""
    velocity_rad_s: Array
    """(N, n_joints)"""
    acceleration_rad_s2: Array
    """(N, n_joints)"""
    contacts: tuple[ContactLink, ...]
    tool: ToolMotion
    position_preload_rad: Array | None = None
    """(N, n_joints) commanded positions that make the grip tight, where they are known."""

    def __post_init__(self) -> None:
        knots, shape = len(self.time_s), (len(self.time_s), len(self.joint_names))
        if knots < 2 or self.time_s[0] != 0.0 or not np.all(np.diff(self.time_s) > 0):
            raise ValueError("time_s: at least two knots, increasing strictly from 0")
        expected = {
            "position_rad": (self.position_rad, shape),
            "velocity_rad_s": (self.velocity_rad_s, shape),
            "acceleration_rad_s2": (self.acceleration_rad_s2, shape),
            "tool.angle_rad": (self.tool.angle_rad, (knots,)),
            "tool.pose_palm": (self.tool.pose_palm, (knots, 7)),
        }
        if self.position_preload_rad is not None:
            expected["position_preload_rad"] = (self.position_preload_rad, shape)
        for name, (values, allowed) in expected.items():
            if values.shape != allowed or not np.all(np.isfinite(values)):
                raise ValueError(f"{name}: {allowed} finite numbers, not {values.shape}")

    @property
    def duration_s(self) -> float:
        """Time from rest at the pose to rest at the pose."""
        return float(self.time_s[-1])

    def grip_speed_rad_s(self) -> float:
        """How fast the grip's goals move against the joints at most; they go evenly between knots."""
        if self.position_preload_rad is None:
            return 0.0
        offset = np.diff(self.position_preload_rad - self.position_rad, axis=0)
        return float((np.abs(offset) / np.diff(self.time_s)[:, None]).max(initial=0.0))

    def joints(self) -> BPoly:
        """Quintics over time [s]: positions (n_joints,) [rad]; derivatives by its `derivative`."""
        return quintics(
            self.time_s, self.position_rad, self.velocity_rad_s, self.acceleration_rad_s2
        )


def build_trajectory(
    path: WieldingPath,
    spec: Spec,
    geometry: HandGeometry,
    project: Project,
    joint_speed_limit: Array,
    grip_offset: Offset | None = None,
) -> Trajectory:
    """From rest at the pose to the plus end, back, to the minus end, back, to rest at the pose.

    Args:
        path: states of the path.
        spec: the pose's contacts and turning, the joints' ranges, limits of motion.
        geometry: the hand that the path belongs to.
        project: gives the exact contact posture (n,) [rad] nearest to a guess (n,) at a tool angle.
        joint_speed_limit: (n,) or (n_fingers, n_joints) what the motors reach [rad/s].
        grip_offset: how far the grip's goals will lie beyond the joints, so that they too keep to
            their speed; without it, they are not looked at.

    Raises:
        MakeError: contact cannot be kept along the path.
    """
    pose = spec.poses[path.pose]
    contacts = tuple(ContactLink(contact.finger, contact.link) for contact in pose.contacts)
    grip = Grip(geometry, spec.tool, pose.turning, path.hand_in_tool, contacts)
    limits = motion_limits(spec, joint_speed_limit)
    ranges = joint_ranges(spec)
    rounds = []
    for leg in legs(path):
        curve = contact_curve(leg, grip, project, ranges)
        offset = None if grip_offset is None else _along(leg, grip_offset)
        motion = _timed(leg, curve, grip, ranges, limits, offset)
        rounds.append(_there_and_back(motion, leg.direction))
    return _named(spec, grip, _joined(rounds) if rounds else _resting(path))


def _along(leg: Leg, offset: Offset) -> Offset:
    """The grip's offset over a leg's own turn, which is never negative."""
    return lambda turn: offset(leg.direction * turn)


def _timed(
    leg: Leg,
    curve: ContactCurve,
    grip: Grip,
    ranges: Array,
    limits: MotionLimits,
    offset: Offset | None,
) -> Motion:
    """The fastest motion along a leg; where its quintics pass a limit, that cell is slowed."""
    usable = np.ones(clock_cells(curve))
    for _ in range(SLOWING_ROUNDS):
        law = fastest_law(curve, limits, usable)
        clock = _in_contact(law, len(usable), leg, grip, ranges)
        motion = law.at(clock)
        pressed = pressure(motion, limits, offset)
        if pressed.max() <= 1.0 + PRESSURE_TOLERANCE:
            break
        cells = ((clock[:-1] + clock[1:]) / 2 / law.ramp.end * len(usable)).astype(int)
        excess = np.ones(len(usable))
        np.maximum.at(excess, cells, pressed)
        usable /= excess
    return slowed(motion, np.sqrt(max(1.0, pressed.max())))


def _in_contact(law: TimeLaw, cells: int, leg: Leg, grip: Grip, joint_range: Array) -> Array:
    """Clock angles of knots so close that contact holds between them.

    Between two knots the tool counts as turning evenly: so can every reader of the file tell where
    it is.
    """
    clock = np.linspace(0.0, law.ramp.end, cells + 1)
    inside = np.linspace(0.0, 1.0, 9)[1:-1]
    for _ in range(MAX_SPLITS):
        motion = law.at(clock)
        times = motion.time[:-1, None] + np.diff(motion.time)[:, None] * inside
        turns = motion.turn[:-1, None] + np.diff(motion.turn)[:, None] * inside
        joints = motion.joints()(times.ravel())
        errors = grip.errors(joints, leg.direction * turns.ravel())
        excess = limit_excess(joints, joint_range, leg)
        faulty = (errors > FILE_GAP_MM) | (excess > LIMIT_EXCESS_RAD)
        faulty = faulty.reshape(times.shape).any(axis=1)
        if not faulty.any():
            return clock
        clock = np.sort(np.concatenate([clock, ((clock[:-1] + clock[1:]) / 2)[faulty]]))
    raise MakeError("contact is lost between the knots of a trajectory, however close they are")


def _there_and_back(there: Motion, direction: float) -> Motion:
    """A leg and its mirror image in time, with the tool's angle signed."""
    back = Motion(
        time=2 * there.time[-1] - there.time[-2::-1],
        turn=there.turn[-2::-1],
        position=there.position[-2::-1],
        velocity=-there.velocity[-2::-1],
        acceleration=there.acceleration[-2::-1],
    )
    both = Motion(*(np.concatenate(pair) for pair in zip(there, back, strict=True)))
    return both._replace(turn=direction * both.turn)


def _joined(rounds: list[Motion]) -> Motion:
    """Rounds one after the other; each starts where the one before rests."""
    whole, *others = rounds
    for motion in others:
        later = motion._replace(time=motion.time + whole.time[-1])
        whole = Motion(*(np.concatenate([a, b[1:]]) for a, b in zip(whole, later, strict=True)))
    return whole


def _resting(path: WieldingPath) -> Motion:
    """A path without a step: the pose, held."""
    position = np.repeat(path.joints_rad.reshape(1, -1), 2, axis=0)
    still = np.zeros_like(position)
    return Motion(np.array([0.0, REST_S]), np.zeros(2), position, still, still)


def _named(spec: Spec, grip: Grip, motion: Motion) -> Trajectory:
    names = TEMPLATES[spec.hand.template]
    origin, orientation = grip.tool_poses(motion.turn)
    quaternions = orientation.as_quat(scalar_first=True)
    tool = ToolMotion(
        radius_m=spec.tool.radius_mm * M_PER_MM,
        back_m=spec.tool.back_mm * M_PER_MM,
        tip_m=spec.tool.tip_mm * M_PER_MM,
        angle_rad=motion.turn,
        pose_palm=np.hstack([origin * M_PER_MM, _continuous(quaternions)]),
    )
    return Trajectory(
        joint_names=tuple(f"{f}_{j}" for f in names.fingers for j in names.joints),
        time_s=motion.time,
        position_rad=motion.position,
        velocity_rad_s=motion.velocity,
        acceleration_rad_s2=motion.acceleration,
        contacts=grip.contacts,
        tool=tool,
    )


def _continuous(quaternions: Array) -> Array:
    """The same rotations (N, 4), each quaternion on the side of the one before."""
    turned_over = np.einsum("ij,ij->i", quaternions[1:], quaternions[:-1]) < 0
    sign = np.cumprod(np.concatenate([[1.0], np.where(turned_over, -1.0, 1.0)]))
    return quaternions * sign[:, None]
