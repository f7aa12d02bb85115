"""Random postures of clay's poses, in contact or not."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from fpcad.sample.space import design_space
from fpcad.spec.schema import Spec
from tests.model.plain_hand import (
    FINGERS,
    Array,
    Posture,
    distal_touch,
    hand_frame,
    link_frame,
)

APEX_FRACTION = 0.9


def random_posture(spec: Spec, pose: str, seed: int) -> Posture:
    """Anything within the joints' limits: hand anywhere, contacts on cylinders and tips."""
    random = np.random.default_rng([seed, *pose.encode()])
    space = design_space(spec.hand)
    d = space.internal(space.named(random.uniform(-0.5, 0.5, len(space.names))))
    low, high = np.radians(
        [spec.hand.joint_limits_deg[j] for j in ("mcp_flex", "mcp_abd", "ip_flex")]
    ).T
    fingers = tuple(contact.finger for contact in spec.poses[pose].contacts)
    n = len(fingers)
    reach = d[0] - d[3] / 2 + APEX_FRACTION * np.pi / 4 * d[3]
    a = np.column_stack(
        [
            random.uniform(-70, 70, n),
            random.uniform(-np.pi, np.pi, n),
            random.uniform(0.2 * reach, reach, n),
            random.uniform(-1.7, 1.7, n),
        ]
    )
    h = np.concatenate([random.uniform(-60, 60, 3), random.uniform(-1.4, 1.4, 3)])
    return Posture(fingers, d, random.uniform(-0.5, 0.5), h, random.uniform(low, high, (4, 3)), a)


def touching_posture(
    spec: Spec,
    pose: str,
    contact: int,
    arclength: float,
    seed: int,
    spin: float | None = None,
) -> Posture:
    """A random posture whose hand is moved so that one contact is closed.

    Args:
        contact: which one.
        arclength: where on the finger [mm], from the end of its cylinder on.
        spin: angle [rad] between the axes of tool and finger; random, and never near parallel,
            where there are no contact rates, if not given.
    """
    posture = random_posture(spec, pose, seed)
    cylinder = posture.d[0] - posture.d[3] / 2
    posture.a[contact, 2] = cylinder + arclength
    random = np.random.default_rng(seed)
    tool = posture.tool(contact)
    name = posture.fingers[contact]
    link = link_frame(name, "distal", posture.d, posture.u[FINGERS.index(name)])
    touch = distal_touch(posture.d, *posture.a[contact, 2:]).seen_from(link)
    spin = random.uniform(0.3, 1.2) if spin is None else spin
    R = (
        _frame(-tool.normal, tool.tangents[:, 0])
        @ _about_z(spin)
        @ _frame(touch.normal, touch.tangents[:, 0]).T
    )
    euler = Rotation.from_matrix(R).as_euler("xyz")
    h = np.concatenate([tool.p - R @ touch.p, euler])
    assert np.allclose(hand_frame(h).R, R)
    return posture._replace(h=h)


def _frame(normal: Array, tangent: Array) -> Array:
    return np.stack([tangent, np.cross(normal, tangent), normal], axis=1)


def _about_z(angle: float) -> Array:
    return Rotation.from_euler("z", angle).as_matrix()
