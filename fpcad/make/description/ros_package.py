"""The ROS 2 package of a hand, written without ROS. docs/description.md."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path

from jinja2 import Environment, FunctionLoader, StrictUndefined

from fpcad.make.description.markup import number
from fpcad.make.description.motion_message import messages
from fpcad.make.description.robot import BASE_LINK, Robot
from fpcad.make.description.srdf import ALL_JOINTS, srdf_text
from fpcad.make.description.urdf import SOFT_LIMIT_RATE, velocity_gain
from fpcad.make.description.xacro import (
    COMMANDS,
    STATES,
    control_macro,
    hand_macro,
    package_name,
    ros_name,
    top_xacro,
)
from fpcad.make.documents.stamp import Stamp
from fpcad.make.trajectory import Trajectory

TEMPLATES = {
    "package.xml": "package.xml.j2",
    "CMakeLists.txt": "CMakeLists.txt.j2",
    "launch/display.launch.py": "display.launch.py.j2",
    "launch/control.launch.py": "control.launch.py.j2",
    "rviz/display.rviz": "display.rviz.j2",
    "config/joint_limits.yaml": "joint_limits.yaml.j2",
    "config/controllers.yaml": "controllers.yaml.j2",
}
"""Files of the package that are filled in, and what from."""


def write_ros_package(
    robot: Robot, trajectories: Mapping[str, Trajectory], meshes: Path, folder: Path, stamp: Stamp
) -> list[Path]:
    """Write the package into a folder of its own name.

    Args:
        robot: the hand.
        trajectories: its trajectories, by pose.
        meshes: folder of its visual meshes, which are copied: a package stands alone.
        folder: the `hand` folder of a build.
        stamp: goes into every file.
    """
    package, name = folder / package_name(robot), ros_name(robot)
    texts = {
        f"urdf/{name}.urdf.xacro": top_xacro(robot),
        f"urdf/{name}.xacro": hand_macro(robot),
        f"urdf/{name}.ros2_control.xacro": control_macro(robot),
        f"config/{name}.srdf": srdf_text(robot),
        **{target: _filled(template, robot) for target, template in TEMPLATES.items()},
        **{
            f"trajectories/{file}": text
            for pose, trajectory in trajectories.items()
            for file, text in messages(pose, trajectory).items()
        },
    }
    written = [stamp.write(package / target, text) for target, text in texts.items()]
    used = dict.fromkeys(mesh for link in robot.links for mesh, _ in link.body.visuals)
    for mesh in used:
        copy = package / "meshes" / "visual" / f"{mesh}.stl"
        written.append(stamp.write(copy, (meshes / f"{mesh}.stl").read_bytes()))
    return written


def _filled(template: str, robot: Robot) -> str:
    environment = Environment(
        loader=FunctionLoader(_source),
        undefined=StrictUndefined,
        keep_trailing_newline=True,
        trim_blocks=True,
    )
    environment.filters["number"] = number
    return environment.get_template(template).render(
        robot=robot,
        package=package_name(robot),
        name=ros_name(robot),
        version=version("fpcad"),
        base=BASE_LINK,
        group=ALL_JOINTS,
        commands=COMMANDS,
        states=STATES,
        soft_limit_rate=SOFT_LIMIT_RATE,
        velocity_gain=velocity_gain,
    )


def _source(template: str) -> str:
    return (files("fpcad.make.description") / "ros2" / template).read_text(encoding="utf-8")
