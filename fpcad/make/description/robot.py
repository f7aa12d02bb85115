"""The hand as every description format tells it: links, joints, motors and postures in SI units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.make.description.mount import mount_shapes
from fpcad.make.description.shapes import Capsule, Shape
from fpcad.make.inertia import Inertia
from fpcad.make.preload.stiffness import hand_stiffness
from fpcad.make.primitives import pose_along
from fpcad.make.servo import Servo, servo_of
from fpcad.make.trajectory import Trajectory
from fpcad.model.geometry import HandGeometry
from fpcad.model.transmission import (
    finger_transmission,
    hand_transmission,
    motor_angles,
    single_axis_speed_limits,
    single_axis_torque_limits,
)
from fpcad.spec.catalogue import motor
from fpcad.spec.schema import Spec
from fpcad.spec.templates import TEMPLATES
from fpcad.units import M_PER_MM, NM_PER_NMM, RAD_PER_DEG

Array = NDArray[np.float64]

BASE_LINK = "palm"
MOTORS_OF_A_FINGER = ("m1", "m2", "m3")
COLOURS = {
    "endoskeleton": (0.92, 0.91, 0.87, 1.0),
    "skin": (0.88, 0.45, 0.30, 1.0),
    "metal": (0.62, 0.64, 0.67, 1.0),
}
"""Red, green, blue, opacity of the printed materials."""
SOFT_MARGIN_RAD = 1e-3
"""How far soft limits lie inside the hard ones: a tenth of a millimetre at the fingertip.

Paths may rest at the hard limits, so a wider margin would move a finger off the tool.
"""
STRETCH_RAD = 1.0
"""How far targets of motors may lie beyond what the joints reach; MuJoCo cuts them off there."""
KG_PER_G = 1e-3
X, Y, Z = np.eye(3)


@dataclass(frozen=True)
class LinkBody:
    """What a link is made of, the same for every finger."""

    inertia: Inertia
    visuals: tuple[tuple[str, str], ...]
    """Name of the mesh and its material, for each visual."""


@dataclass(frozen=True)
class Link:
    """A rigid body with what is seen and what is touched of it."""

    name: str
    body: LinkBody
    shapes: tuple[Shape, ...] = ()


@dataclass(frozen=True)
class Joint:
    """A revolute joint, with what the motors give it alone."""

    name: str
    finger: str
    parent: str
    child: str
    pose: Array
    """(4, 4) of the child in the parent at angle 0 [m]."""
    axis: Array  # (3,)
    lower_rad: float
    upper_rad: float
    torque_nm: float
    speed_rad_s: float
    acceleration_rad_s2: float

    @property
    def soft_rad(self) -> tuple[float, float]:
        """Limits at which a controller should come to rest."""
        return self.lower_rad + SOFT_MARGIN_RAD, self.upper_rad - SOFT_MARGIN_RAD


@dataclass(frozen=True)
class Posture:
    """The hand at a foundational pose, and the tool in it."""

    name: str
    joints_rad: Array  # (n_joints,)
    command_rad: Array
    """(n_joints,) what the joints are told: with grip preload where it is known."""
    tool_palm: Array
    """(7,) xyz [m] and quaternion w x y z of the tool's frame O in `palm`."""


@dataclass(frozen=True)
class Stick:
    """The tool: a cylinder along x of its frame O [m]."""

    radius: float
    back: float
    tip: float
    mass_kg: float


@dataclass(frozen=True)
class Robot:
    """The whole hand; exporters read nothing else."""

    name: str
    links: tuple[Link, ...]
    joints: tuple[Joint, ...]
    motors: tuple[str, ...]
    A: Array
    """(n_motors, n_joints): motor angles are A times joint angles."""
    servo: Servo
    """A motor with its tendon."""
    friction: float
    postures: tuple[Posture, ...]
    tool: Stick

    @property
    def fingers(self) -> tuple[str, ...]:
        """Names of the fingers in the order of their joints."""
        return tuple(dict.fromkeys(joint.finger for joint in self.joints))

    def never_touching(self) -> list[tuple[str, str, str]]:
        """Pairs of links whose shapes overlap by construction, each with the reason.

        Neighbours in a chain do, and a proximal link does with the palm in which it roots.
        """
        pairs = [(joint.parent, joint.child, "Adjacent") for joint in self.joints]
        two_apart = [
            (first.parent, second.child, "Default")
            for first in self.joints
            for second in self.joints
            if first.child == second.parent
        ]
        return pairs + two_apart


def describe(
    spec: Spec,
    geometry: HandGeometry,
    bodies: Mapping[str, LinkBody],
    trajectories: Mapping[str, Trajectory],
) -> Robot:
    """The hand of a geometry; `bodies` by `palm`, `mcp`, `proximal`, `distal`, trajectories by pose."""
    names, row = TEMPLATES[spec.hand.template], motor(spec.motors.type)
    A = hand_transmission(spec.motors.transmission, len(names.fingers))
    links, joints = [_palm(spec, geometry, bodies["palm"])], []
    for finger in geometry.fingers:
        links += _finger_links(geometry, finger, bodies)
        joints += _finger_joints(spec, geometry, finger)
    return Robot(
        name=spec.name,
        links=tuple(links),
        joints=tuple(joints),
        motors=tuple(f"{finger}_{m}" for finger in names.fingers for m in MOTORS_OF_A_FINGER),
        A=A,
        servo=servo_of(row).behind_tendon(hand_stiffness(spec).motor_nmm_rad * NM_PER_NMM),
        friction=spec.statics.friction,
        postures=tuple(_posture(name, trajectories[name]) for name in trajectories),
        tool=_stick(spec),
    )


def motor_command(robot: Robot, posture: Posture) -> Array:
    """Motor angles (n_motors,) [rad] that a posture's command stands for."""
    return motor_angles(robot.A, posture.command_rad)


def motor_range(robot: Robot) -> tuple[Array, Array]:
    """Lowest and highest target (n_motors,) [rad] that can mean anything to a motor.

    The range of its angle over all joint angles, and beyond it what stretched tendons take up.
    """
    lower = np.array([joint.lower_rad for joint in robot.joints])
    upper = np.array([joint.upper_rad for joint in robot.joints])
    positive, negative = np.maximum(robot.A, 0.0), np.minimum(robot.A, 0.0)
    return (
        positive @ lower + negative @ upper - STRETCH_RAD,
        positive @ upper + negative @ lower + STRETCH_RAD,
    )


def _palm(spec: Spec, geometry: HandGeometry, body: LinkBody) -> Link:
    shapes = tuple(
        Capsule(s.name, s.start_mm * M_PER_MM, s.end_mm * M_PER_MM, s.radius_mm * M_PER_MM)
        for s in geometry.palm
    )
    return Link(BASE_LINK, body, (*shapes, *mount_shapes(spec, geometry)))


def _finger_links(
    geometry: HandGeometry, finger: str, bodies: Mapping[str, LinkBody]
) -> list[Link]:
    radius = geometry.radius_mm * M_PER_MM
    lengths = {
        "proximal": geometry.proximal_length_mm * M_PER_MM,
        "distal": (geometry.distal_length_mm - geometry.radius_mm) * M_PER_MM,
    }
    shapes = {
        link: (Capsule(f"{finger}_{link}", np.zeros(3), length * X, radius),)
        for link, length in lengths.items()
    }
    return [
        Link(f"{finger}_{link}", bodies[link], shapes.get(link, ()))
        for link in ("mcp", "proximal", "distal")
    ]


def _finger_joints(spec: Spec, geometry: HandGeometry, finger: str) -> list[Joint]:
    root = geometry.T_palm_root[finger].copy()
    root[:3, 3] *= M_PER_MM
    poses = (root, np.eye(4), pose_along(geometry.proximal_length_mm * M_PER_MM * X))
    chain = (BASE_LINK, f"{finger}_mcp", f"{finger}_proximal", f"{finger}_distal")
    row, A = motor(spec.motors.type), finger_transmission(spec.motors.transmission)
    torques = single_axis_torque_limits(A, row.continuous_torque_nm)
    speeds = single_axis_speed_limits(A, row.no_load_speed_rad_s)
    joints = []
    for i, joint in enumerate(TEMPLATES[spec.hand.template].joints):
        lower, upper = (angle * RAD_PER_DEG for angle in spec.hand.joint_limits_deg[joint])
        joints.append(
            Joint(
                name=f"{finger}_{joint}",
                finger=finger,
                parent=chain[i],
                child=chain[i + 1],
                pose=poses[i],
                axis=(Y, Z, Y)[i],
                lower_rad=float(lower),
                upper_rad=float(upper),
                torque_nm=float(torques[i]),
                speed_rad_s=float(speeds[i]),
                acceleration_rad_s2=spec.motion.joint_acceleration_deg_s2 * RAD_PER_DEG,
            )
        )
    return joints


def _posture(name: str, trajectory: Trajectory) -> Posture:
    preload = trajectory.position_preload_rad
    joints = trajectory.position_rad[0]
    command = joints if preload is None else preload[0]
    return Posture(name, joints, command, trajectory.tool.pose_palm[0])


def _stick(spec: Spec) -> Stick:
    radius, back, tip = spec.tool.radius_mm, spec.tool.back_mm, spec.tool.tip_mm
    mass = spec.grip.tool_mass_g * KG_PER_G
    return Stick(radius * M_PER_MM, back * M_PER_MM, tip * M_PER_MM, mass)
