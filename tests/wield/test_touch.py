"""Points of links and tool that are nearest to each other are what contact comes next to."""

from __future__ import annotations

import numpy as np
import pytest

from fpcad.solve.attempt import Workbench
from fpcad.wield.touch import nearest_contacts
from tests.model.plain_hand import FINGERS, Array, hand_frame, link_frame

POSES = ("carve", "poke", "press")


def wrapped(angle: Array) -> Array:
    """Angles [rad] brought to (-pi, pi]."""
    return np.angle(np.exp(1j * angle))


@pytest.mark.parametrize("pose", POSES)
def test_in_contact_they_are_the_contacts(bench: Workbench, first_hand, wielding, pose: str):
    path = wielding[pose].path
    for angle, joints, contacts in zip(
        path.tool_angle_rad[::5], path.joints_rad[::5], path.contacts[::5], strict=True
    ):
        found = nearest_contacts(
            bench, pose, first_hand.design, path.hand_in_tool, angle, joints.ravel()
        )
        assert np.abs(found[:, [0, 2]] - contacts[:, [0, 2]]).max() < 1e-6
        assert np.abs(wrapped(found[:, [1, 3]] - contacts[:, [1, 3]])).max() < 1e-6


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("pose", POSES)
def test_off_contact_no_point_of_a_links_axis_is_nearer(
    bench: Workbench, first_hand, wielding, pose: str, seed: int
):
    """The tool taken as endless; links are sampled along their axes."""
    path, d = wielding[pose].path, first_hand.design
    random = np.random.default_rng(seed)
    angle = random.uniform(-0.3, 0.3)
    joints = wielding[pose].pose[6:18] + random.normal(size=12) * 0.1
    found = nearest_contacts(bench, pose, d, path.hand_in_tool, angle, joints)
    tool = np.array([np.cos(angle), np.sin(angle), 0.0])
    for (axial, _, s, _), contact in zip(found, bench.spec.poses[pose].contacts, strict=True):
        u = joints.reshape(4, 3)[FINGERS.index(contact.finger)]
        link = hand_frame(path.hand_in_tool) @ link_frame(contact.finger, "distal", d, u)
        end = d[0] - d[3] / 2
        axis = link.p + np.linspace(0, end, 20_001)[:, None] * link.R[:, 0]
        off_tool = np.linalg.norm(axis - np.outer(axis @ tool, tool), axis=1)
        nearest = link.p + min(s, end) * link.R[:, 0]
        assert np.linalg.norm(nearest - axial * tool) <= off_tool.min() + 1e-9
