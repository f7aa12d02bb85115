"""The hand for MuJoCo: alone, to be attached, and in a scene with its tool. docs/description.md."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fpcad.make.description.markup import document, number
from fpcad.make.description.robot import (
    BASE_LINK,
    COLOURS,
    Joint,
    Link,
    Robot,
    Stick,
    motor_command,
    motor_range,
)
from fpcad.make.description.shapes import Capsule, Cuboid, Shape
from fpcad.make.inertia import Inertia
from fpcad.make.primitives import vector_text

Array = NDArray[np.float64]

MESHES = "../meshes/visual"
ROLLING_FRICTION = (0.005, 0.0001)
"""Torsional and rolling friction [m], MuJoCo's defaults; with condim 3 they have no effect."""
TOOL = "tool"
LIGHTS = ((0.3, -0.4, 0.8), (-0.4, 0.3, -0.6))
"""Where the scene's light comes from."""
TOOL_COLOUR = (0.73, 0.55, 0.32, 1.0)


def hand_mjcf(robot: Robot) -> str:
    """The hand alone: body `palm` fixed to the world, so that it can be attached to another model."""
    root = _model(robot, robot.name)
    _hand_body(ET.SubElement(root, "worldbody"), robot)
    _mechanism(root, robot)
    _keyframes(root, robot, with_tool=False)
    return document(root)


def scene_mjcf(robot: Robot) -> str:
    """The same hand with light and the free tool; complete in itself."""
    root = _model(robot, f"{robot.name} scene")
    ET.SubElement(root, "option", integrator="implicitfast", cone="elliptic", impratio="10")
    _stage(root)
    world = ET.SubElement(root, "worldbody")
    for x, y, z in LIGHTS:
        place, direction = vector_text((x, y, z)), vector_text((-x, -y, -z))
        ET.SubElement(world, "light", pos=place, dir=direction, directional="true")
    _hand_body(world, robot)
    _tool_body(world, robot.tool)
    _mechanism(root, robot)
    _keyframes(root, robot, with_tool=True)
    return document(root)


def _stage(root: ET.Element) -> None:
    """Background and picture size."""
    visual = ET.SubElement(root, "visual")
    ET.SubElement(visual, "global", offwidth="1280", offheight="960")
    ET.SubElement(root, "statistic", center="0 0 -0.03", extent="0.25")
    ET.SubElement(
        ET.SubElement(root, "asset"),
        "texture",
        type="skybox",
        builtin="gradient",
        rgb1="1 1 1",
        rgb2="0.8 0.84 0.88",
        width="64",
        height="384",
    )


def _model(robot: Robot, name: str) -> ET.Element:
    root = ET.Element("mujoco", model=name)
    ET.SubElement(root, "compiler", angle="radian", autolimits="true", meshdir=MESHES)
    _defaults(root, robot)
    assets = ET.SubElement(root, "asset")
    for material, colour in COLOURS.items():
        ET.SubElement(assets, "material", name=material, rgba=vector_text(colour))
    meshes = dict.fromkeys(mesh for link in robot.links for mesh, _ in link.body.visuals)
    for mesh in meshes:
        ET.SubElement(assets, "mesh", name=mesh, file=f"{mesh}.stl")
    return root


def _defaults(root: ET.Element, robot: Robot) -> None:
    servo = robot.servo
    defaults = ET.SubElement(root, "default")
    visual = ET.SubElement(defaults, "default", {"class": "visual"})
    ET.SubElement(visual, "geom", type="mesh", contype="0", conaffinity="0", group="2")
    collision = ET.SubElement(defaults, "default", {"class": "collision"})
    friction = vector_text((robot.friction, *ROLLING_FRICTION))
    ET.SubElement(collision, "geom", group="3", condim="3", friction=friction)
    motor = ET.SubElement(defaults, "default", {"class": "motor"})
    ET.SubElement(
        motor,
        "position",
        kp=number(servo.stiffness_nm_rad),
        kv=number(servo.damping_nms_rad),
        forcerange=vector_text((-servo.torque_nm, servo.torque_nm)),
    )


def _hand_body(world: ET.Element, robot: Robot) -> None:
    links = {link.name: link for link in robot.links}
    bodies = {BASE_LINK: _body(world, links[BASE_LINK])}
    for joint in robot.joints:
        bodies[joint.child] = _body(bodies[joint.parent], links[joint.child], joint)


def _body(parent: ET.Element, link: Link, joint: Joint | None = None) -> ET.Element:
    body = ET.SubElement(parent, "body", name=link.name)
    if joint is not None:
        body.set("pos", vector_text(joint.pose[:3, 3]))
        body.set("quat", vector_text(quaternion(joint.pose[:3, :3])))
    _inertial(body, link.body.inertia)
    if joint is not None:
        limits = vector_text((joint.lower_rad, joint.upper_rad))
        axis = vector_text(joint.axis)
        ET.SubElement(body, "joint", name=joint.name, type="hinge", axis=axis, range=limits)
    for mesh, material in link.body.visuals:
        ET.SubElement(body, "geom", {"class": "visual"}, mesh=mesh, material=material)
    for shape in link.shapes:
        _collision(body, shape)
    return body


def _collision(body: ET.Element, shape: Shape) -> None:
    geom = ET.SubElement(body, "geom", {"class": "collision"}, name=shape.name)
    if isinstance(shape, Cuboid):
        geom.set("type", "box")
        geom.set("pos", vector_text(shape.pose[:3, 3]))
        geom.set("quat", vector_text(quaternion(shape.pose[:3, :3])))
        geom.set("size", vector_text(shape.size / 2))
        return
    if np.array_equal(shape.start, shape.end):
        geom.set("type", "sphere")
        geom.set("pos", vector_text(shape.start))
    else:
        geom.set("type", "capsule" if isinstance(shape, Capsule) else "cylinder")
        geom.set("fromto", vector_text((*shape.start, *shape.end)))
    geom.set("size", number(shape.radius))


def _inertial(body: ET.Element, inertia: Inertia) -> None:
    tensor = inertia.tensor_kgm2
    entries = (tensor[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)))
    ET.SubElement(
        body,
        "inertial",
        pos=vector_text(inertia.centre_m),
        mass=number(inertia.mass_kg),
        fullinertia=vector_text(entries),
    )


def _tool_body(world: ET.Element, tool: Stick) -> None:
    body = ET.SubElement(world, "body", name=TOOL)
    ET.SubElement(body, "freejoint", name=TOOL)
    ET.SubElement(
        body,
        "geom",
        {"class": "collision"},
        name=TOOL,
        type="cylinder",
        fromto=vector_text((tool.back, 0.0, 0.0, tool.tip, 0.0, 0.0)),
        size=number(tool.radius),
        mass=number(tool.mass_kg),
        rgba=vector_text(TOOL_COLOUR),
        group="2",
    )
    ET.SubElement(
        body, "site", name=f"{TOOL}_tip", pos=vector_text((tool.tip, 0.0, 0.0)), size="0.001"
    )


def _mechanism(root: ET.Element, robot: Robot) -> None:
    """Pairs that cannot collide, and the motors: one fixed tendon for each row of A."""
    contact = ET.SubElement(root, "contact")
    for first, second, _ in robot.never_touching():
        ET.SubElement(contact, "exclude", body1=first, body2=second)
    tendons, actuators = ET.SubElement(root, "tendon"), ET.SubElement(root, "actuator")
    for motor, row, low, high in zip(robot.motors, robot.A, *motor_range(robot), strict=True):
        inertia = number(robot.servo.inertia_kgm2)
        tendon = ET.SubElement(tendons, "fixed", name=motor, armature=inertia)
        for joint, coefficient in zip(robot.joints, row, strict=True):
            if coefficient:
                ET.SubElement(tendon, "joint", joint=joint.name, coef=number(coefficient))
        ET.SubElement(
            actuators,
            "position",
            {"class": "motor"},
            name=motor,
            tendon=motor,
            ctrlrange=vector_text((low, high)),
        )


def _keyframes(root: ET.Element, robot: Robot, with_tool: bool) -> None:
    """The foundational poses; the commands hold grip preload where it is known."""
    keyframes = ET.SubElement(root, "keyframe")
    for posture in robot.postures:
        tool: Iterable[float] = posture.tool_palm if with_tool else ()
        ET.SubElement(
            keyframes,
            "key",
            name=posture.name,
            qpos=vector_text((*posture.joints_rad, *tool)),
            ctrl=vector_text(motor_command(robot, posture)),
        )


def quaternion(R: Array) -> Array:
    """Unit quaternion w x y z (4,) of a rotation (3, 3), w >= 0."""
    x, y, z, w = Rotation.from_matrix(R).as_quat()
    return math.copysign(1.0, w) * np.array([w, x, y, z])
