"""The hand's URDF: links, joints and primitive collision shapes, in SI units. docs/parts.md."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.make.inertia import Inertia
from fpcad.make.primitives import (
    capsule_collision,
    origin_element,
    pose_along,
    vector_text,
)
from fpcad.model.geometry import HandGeometry
from fpcad.spec.schema import Spec
from fpcad.spec.templates import TEMPLATES
from fpcad.units import M_PER_MM, RAD_PER_DEG

Array = NDArray[np.float64]

BASE_LINK = "palm"

COLOURS = {"endoskeleton": (0.92, 0.91, 0.87, 1.0), "skin": (0.88, 0.45, 0.30, 1.0)}
"""Red, green, blue, opacity of the printed materials."""


@dataclass(frozen=True)
class LinkBody:
    """What a link is made of, the same for every finger."""

    inertia: Inertia
    visuals: tuple[tuple[str, str], ...]
    """Mesh file, relative to the URDF, and material of each visual."""


@dataclass(frozen=True)
class JointDrive:
    """What the motors give one joint alone."""

    torque_nm: float
    speed_rad_s: float


def urdf_text(
    spec: Spec,
    geometry: HandGeometry,
    bodies: Mapping[str, LinkBody],
    drives: Sequence[JointDrive],
) -> str:
    """The whole URDF; `bodies` by `palm`, `mcp`, `proximal`, `distal`, one drive a finger's joint."""
    robot = ET.Element("robot", name=spec.name)
    for material, colour in COLOURS.items():
        element = ET.SubElement(robot, "material", name=material)
        ET.SubElement(element, "color", rgba=vector_text(colour))
    palm = _link(robot, BASE_LINK, bodies["palm"])
    for shape in geometry.palm:
        start, end = shape.start_mm * M_PER_MM, shape.end_mm * M_PER_MM
        capsule_collision(palm, shape.name, start, end, shape.radius_mm * M_PER_MM)
    for finger in geometry.fingers:
        _finger(robot, spec, geometry, finger, bodies, drives)
    ET.indent(robot)
    return '<?xml version="1.0"?>\n' + ET.tostring(robot, encoding="unicode") + "\n"


def _finger(
    robot: ET.Element,
    spec: Spec,
    geometry: HandGeometry,
    finger: str,
    bodies: Mapping[str, LinkBody],
    drives: Sequence[JointDrive],
) -> None:
    radius = geometry.radius_mm * M_PER_MM
    proximal = geometry.proximal_length_mm * M_PER_MM
    distal_axis = (geometry.distal_length_mm - geometry.radius_mm) * M_PER_MM
    root = geometry.T_palm_root[finger].copy()
    root[:3, 3] *= M_PER_MM
    origins = (root, np.eye(4), pose_along(np.array([proximal, 0.0, 0.0])))
    _link(robot, f"{finger}_mcp", bodies["mcp"])
    for link, length in (("proximal", proximal), ("distal", distal_axis)):
        element = _link(robot, f"{finger}_{link}", bodies[link])
        end = np.array([length, 0.0, 0.0])
        capsule_collision(element, f"{finger}_{link}", np.zeros(3), end, radius)
    chain = (BASE_LINK, f"{finger}_mcp", f"{finger}_proximal", f"{finger}_distal")
    joints = TEMPLATES[spec.hand.template].joints
    for number, (joint, axis) in enumerate(zip(joints, ("0 1 0", "0 0 1", "0 1 0"), strict=True)):
        element = ET.SubElement(robot, "joint", name=f"{finger}_{joint}", type="revolute")
        origin_element(element, origins[number])
        ET.SubElement(element, "parent", link=chain[number])
        ET.SubElement(element, "child", link=chain[number + 1])
        ET.SubElement(element, "axis", xyz=axis)
        low, high = (a * RAD_PER_DEG for a in spec.hand.joint_limits_deg[joint])
        ET.SubElement(
            element,
            "limit",
            lower=repr(float(low)),
            upper=repr(float(high)),
            effort=repr(float(drives[number].torque_nm)),
            velocity=repr(float(drives[number].speed_rad_s)),
        )


def _link(robot: ET.Element, name: str, body: LinkBody) -> ET.Element:
    link = ET.SubElement(robot, "link", name=name)
    _inertial(link, body.inertia)
    for mesh, material in body.visuals:
        visual = ET.SubElement(link, "visual")
        geometry = ET.SubElement(visual, "geometry")
        ET.SubElement(geometry, "mesh", filename=mesh)
        ET.SubElement(visual, "material", name=material)
    return link


def _inertial(link: ET.Element, inertia: Inertia) -> None:
    element = ET.SubElement(link, "inertial")
    origin_element(element, pose_along(inertia.centre_m))
    ET.SubElement(element, "mass", value=repr(inertia.mass_kg))
    entries = {
        f"i{'xyz'[i]}{'xyz'[j]}": repr(float(inertia.tensor_kgm2[i, j]))
        for i in range(3)
        for j in range(i, 3)
    }
    ET.SubElement(element, "inertia", entries)
