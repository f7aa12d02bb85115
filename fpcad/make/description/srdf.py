"""The hand's SRDF for planners: groups, the poses as named states, pairs that need no checking."""

from __future__ import annotations

import itertools
import xml.etree.ElementTree as ET

from fpcad.make.description.markup import document, number
from fpcad.make.description.robot import BASE_LINK, Robot

ALL_JOINTS = "hand"
"""The group of all joints."""


def srdf_text(robot: Robot) -> str:
    """One group a finger and one of all; a state for each foundational pose."""
    root = ET.Element("robot", name=robot.name)
    for finger in robot.fingers:
        group = ET.SubElement(root, "group", name=finger)
        tip = [joint.child for joint in robot.joints if joint.finger == finger][-1]
        ET.SubElement(group, "chain", base_link=BASE_LINK, tip_link=tip)
    everything = ET.SubElement(root, "group", name=ALL_JOINTS)
    for finger in robot.fingers:
        ET.SubElement(everything, "group", name=finger)
    for posture in robot.postures:
        state = ET.SubElement(root, "group_state", name=posture.name, group=ALL_JOINTS)
        for joint, angle in zip(robot.joints, posture.joints_rad, strict=True):
            ET.SubElement(state, "joint", name=joint.name, value=number(angle))
    for first, second, reason in disabled_pairs(robot):
        ET.SubElement(root, "disable_collisions", link1=first, link2=second, reason=reason)
    return document(root)


def disabled_pairs(robot: Robot) -> list[tuple[str, str, str]]:
    """Pairs that overlap by construction, and all pairs with a link that has no shape."""
    pairs = robot.never_touching()
    known = {frozenset(pair[:2]) for pair in pairs}
    pairs += [
        (a.name, b.name, "Never")
        for a, b in itertools.combinations(robot.links, 2)
        if not (a.shapes and b.shapes) and frozenset((a.name, b.name)) not in known
    ]
    return pairs
