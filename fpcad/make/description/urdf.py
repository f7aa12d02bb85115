"""The hand's URDF: links, joints and primitive collision shapes, in SI units. docs/description.md."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable

from fpcad.make.description.markup import document, number
from fpcad.make.description.robot import (
    COLOURS,
    Joint,
    Link,
    Robot,
)
from fpcad.make.description.shapes import Capsule, Cylinder, Shape
from fpcad.make.inertia import Inertia
from fpcad.make.primitives import (
    box_collision,
    capsule_collision,
    cylinder_collision,
    origin_element,
    pose_along,
    vector_text,
)

SOFT_LIMIT_RATE = 100.0
"""Speed [rad/s] that a controller may have for each rad to a soft limit: paths brake late."""

MeshFile = Callable[[str], str]
"""What a URDF calls the file of a mesh."""


def urdf_text(robot: Robot) -> str:
    """The whole URDF, with meshes relative to its own folder."""
    root = ET.Element("robot", name=robot.name)
    add_materials(root)
    add_links_and_joints(root, robot, lambda mesh: f"../meshes/visual/{mesh}.stl")
    return document(root)


def add_materials(parent: ET.Element, prefix: str = "") -> None:
    """The printed materials' colours; `prefix` comes before their names."""
    for material, colour in COLOURS.items():
        element = ET.SubElement(parent, "material", name=prefix + material)
        ET.SubElement(element, "color", rgba=vector_text(colour))


def add_links_and_joints(
    parent: ET.Element, robot: Robot, mesh_file: MeshFile, prefix: str = ""
) -> None:
    """All links and joints of the hand; `prefix` comes before every name."""
    for link in robot.links:
        _link(parent, link, mesh_file, prefix)
    for joint in robot.joints:
        _joint(parent, joint, prefix)


def _link(parent: ET.Element, link: Link, mesh_file: MeshFile, prefix: str) -> None:
    element = ET.SubElement(parent, "link", name=prefix + link.name)
    _inertial(element, link.body.inertia)
    for mesh, material in link.body.visuals:
        visual = ET.SubElement(element, "visual")
        geometry = ET.SubElement(visual, "geometry")
        ET.SubElement(geometry, "mesh", filename=mesh_file(mesh))
        ET.SubElement(visual, "material", name=prefix + material)
    for shape in link.shapes:
        _collision(element, shape, prefix + shape.name)


def _collision(link: ET.Element, shape: Shape, name: str) -> None:
    if isinstance(shape, Capsule):
        capsule_collision(link, name, shape.start, shape.end, shape.radius)
    elif isinstance(shape, Cylinder):
        cylinder_collision(link, name, shape.start, shape.end, shape.radius)
    else:
        box_collision(link, name, shape.pose, shape.size)


def _joint(parent: ET.Element, joint: Joint, prefix: str) -> None:
    element = ET.SubElement(parent, "joint", name=prefix + joint.name, type="revolute")
    origin_element(element, joint.pose)
    ET.SubElement(element, "parent", link=prefix + joint.parent)
    ET.SubElement(element, "child", link=prefix + joint.child)
    ET.SubElement(element, "axis", xyz=vector_text(joint.axis))
    ET.SubElement(
        element,
        "limit",
        lower=number(joint.lower_rad),
        upper=number(joint.upper_rad),
        effort=number(joint.torque_nm),
        velocity=number(joint.speed_rad_s),
    )
    soft_lower, soft_upper = joint.soft_rad
    ET.SubElement(
        element,
        "safety_controller",
        soft_lower_limit=number(soft_lower),
        soft_upper_limit=number(soft_upper),
        k_position=number(SOFT_LIMIT_RATE),
        k_velocity=number(velocity_gain(joint)),
    )


def velocity_gain(joint: Joint) -> float:
    """Torque for each rad/s beyond a bound [N m s/rad]: all of it at a tenth of the top speed."""
    return joint.torque_nm / (0.1 * joint.speed_rad_s)


def _inertial(link: ET.Element, inertia: Inertia) -> None:
    element = ET.SubElement(link, "inertial")
    origin_element(element, pose_along(inertia.centre_m))
    ET.SubElement(element, "mass", value=number(inertia.mass_kg))
    entries = {
        f"i{'xyz'[i]}{'xyz'[j]}": number(inertia.tensor_kgm2[i, j])
        for i in range(3)
        for j in range(i, 3)
    }
    ET.SubElement(element, "inertia", entries)
