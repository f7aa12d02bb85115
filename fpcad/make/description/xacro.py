"""The hand as xacro macros: to be given a prefix and a parent, and driven by ros2_control."""

from __future__ import annotations

import xml.etree.ElementTree as ET

from fpcad.make.description.markup import document, number
from fpcad.make.description.robot import BASE_LINK, Joint, Robot
from fpcad.make.description.urdf import add_links_and_joints, add_materials

XMLNS = {"xmlns:xacro": "http://www.ros.org/wiki/xacro"}
PREFIX = "${prefix}"
MOCK_HARDWARE = "mock_components/GenericSystem"
COMMANDS, STATES = ("position",), ("position", "velocity")
"""What ros2_control may set of a joint, and what it is told."""


def ros_name(robot: Robot) -> str:
    """The hand's name as ROS allows it: package names have no hyphens."""
    return robot.name.replace("-", "_")


def package_name(robot: Robot) -> str:
    """Name of the ROS 2 package."""
    return f"{ros_name(robot)}_description"


def hand_macro(robot: Robot) -> str:
    """A macro with the hand's links and joints; with a parent, a fixed joint holds `palm` to it."""
    root = ET.Element("robot", XMLNS)
    macro = ET.SubElement(
        root,
        "xacro:macro",
        name=ros_name(robot),
        params="prefix:='' parent:='' xyz:='0 0 0' rpy:='0 0 0'",
    )
    attached = ET.SubElement(macro, "xacro:if", value="${parent != ''}")
    mount = ET.SubElement(attached, "joint", name=f"{PREFIX}mount", type="fixed")
    ET.SubElement(mount, "origin", xyz="${xyz}", rpy="${rpy}")
    ET.SubElement(mount, "parent", link="${parent}")
    ET.SubElement(mount, "child", link=PREFIX + BASE_LINK)
    add_materials(macro, PREFIX)
    package = package_name(robot)
    add_links_and_joints(
        macro, robot, lambda mesh: f"package://{package}/meshes/visual/{mesh}.stl", PREFIX
    )
    return document(root)


def control_macro(robot: Robot) -> str:
    """A macro with the joints' interfaces for ros2_control; mock hardware unless told otherwise."""
    root = ET.Element("robot", XMLNS)
    macro = ET.SubElement(
        root,
        "xacro:macro",
        name=f"{ros_name(robot)}_ros2_control",
        params=f"prefix:='' plugin:='{MOCK_HARDWARE}'",
    )
    system = ET.SubElement(macro, "ros2_control", name=f"{PREFIX}{ros_name(robot)}", type="system")
    ET.SubElement(ET.SubElement(system, "hardware"), "plugin").text = "${plugin}"
    for joint in robot.joints:
        _interfaces(system, joint)
    return document(root)


def top_xacro(robot: Robot) -> str:
    """The file to expand: one hand, on a link `world` unless another parent is given."""
    name = ros_name(robot)
    root = ET.Element("robot", {**XMLNS, "name": robot.name})
    for argument, default in (("prefix", ""), ("parent", "world"), ("plugin", MOCK_HARDWARE)):
        ET.SubElement(root, "xacro:arg", name=argument, default=default)
    for file in (f"{name}.xacro", f"{name}.ros2_control.xacro"):
        ET.SubElement(root, "xacro:include", filename=file)
    ET.SubElement(root, "xacro:property", name="parent", value="$(arg parent)")
    parent = ET.SubElement(root, "xacro:if", value="${parent != ''}")
    ET.SubElement(parent, "link", name="${parent}")
    hand = {"prefix": "$(arg prefix)", "parent": "${parent}"}
    ET.SubElement(root, f"xacro:{name}", hand)
    control = {"prefix": "$(arg prefix)", "plugin": "$(arg plugin)"}
    ET.SubElement(root, f"xacro:{name}_ros2_control", control)
    return document(root)


def _interfaces(system: ET.Element, joint: Joint) -> None:
    element = ET.SubElement(system, "joint", name=PREFIX + joint.name)
    for name in COMMANDS:
        command = ET.SubElement(element, "command_interface", name=name)
        for bound, value in (("min", joint.lower_rad), ("max", joint.upper_rad)):
            ET.SubElement(command, "param", name=bound).text = number(value)
    for name in STATES:
        state = ET.SubElement(element, "state_interface", name=name)
        ET.SubElement(state, "param", name="initial_value").text = number(0.0)
