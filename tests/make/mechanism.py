"""Paths of a real hand without the wielding solver: postures in contact, nearest to a guess."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fpcad.make.grip import ContactLink, Grip
from fpcad.model.geometry import HandGeometry, hand_geometry
from fpcad.model.hand import hand_template
from fpcad.spec.load import load_spec
from fpcad.spec.schema import Spec
from fpcad.spec.templates import TEMPLATES
from fpcad.units import to_internal
from fpcad.wield.path import WieldingPath

Array = NDArray[np.float64]

CLAY = Path(__file__).parents[2] / "designs" / "clay.yaml"


@dataclass(frozen=True)
class Mechanism:
    """The hand that `clay` starts from, in one of its poses."""

    spec: Spec
    pose: str

    @cached_property
    def geometry(self) -> HandGeometry:
        template = hand_template(self.spec.hand)
        return hand_geometry(template, to_internal(template.names.parameters, self._initial.design))

    @cached_property
    def hand_in_tool(self) -> Array:
        pose = self._initial.poses[self.pose]
        return np.concatenate([pose.hand_position_mm, np.radians(pose.hand_rotation_deg)])

    @cached_property
    def posture(self) -> Array:
        """(12,) joints [rad] in exact contact at tool angle 0, free fingers curled out of the way."""
        touching = {contact.finger for contact in self.grip.contacts}
        joints = self._initial.poses[self.pose].joints_deg
        given = [
            joints[f] if f in touching else (100.0, 0.0, 0.0)
            for f in TEMPLATES[self.spec.hand.template].fingers
        ]
        return self.project(0.0, np.radians(np.concatenate(given)))

    @cached_property
    def grip(self) -> Grip:
        pose = self.spec.poses[self.pose]
        contacts = tuple(ContactLink(c.finger, c.link) for c in pose.contacts)
        return Grip(self.geometry, self.spec.tool, pose.turning, self.hand_in_tool, contacts)

    @cached_property
    def limits(self) -> Array:
        """(2, 12) [rad]."""
        one = [self.spec.hand.joint_limits_deg[j] for j in ("mcp_flex", "mcp_abd", "ip_flex")]
        return np.tile(np.radians(one).T, 4)

    def project(self, tool_angle: float, guess: Array) -> Array:
        """Nearest joints (12,) [rad] in contact and within limits: Newton with an active set."""
        low, high = self.limits
        joints, free = np.clip(guess, low, high), np.ones(12, dtype=bool)
        for _ in range(50):
            gap, jacobian = self._linearized(tool_angle, joints)
            wish, J = (guess - joints)[free], jacobian[:, free]
            step = wish + J.T @ np.linalg.solve(J @ J.T, -gap - J @ wish)
            moved = joints.copy()
            moved[free] += step
            free &= (low <= moved) & (moved <= high)
            moved = np.clip(moved, low, high)
            if np.abs(moved - joints).max() < 1e-12:
                return moved
            joints = moved
        raise RuntimeError(f"no contact at a tool angle of {tool_angle} rad")

    def path(self, minus: int, plus: int, step: float = np.radians(1)) -> WieldingPath:
        """So many steps of `step` [rad] each way and half a one at each end that is not the pose."""
        angles, states = [0.0], [self.posture]
        for sign, steps in ((1.0, plus), (-1.0, minus)):
            joints = self.posture
            for k in range(1, steps + 2 if steps else 1):
                angle = sign * step * (k if k <= steps else steps + 0.5)
                joints = self.project(angle, joints)
                angles.append(angle)
                states.append(joints)
        order = np.argsort(angles)
        return WieldingPath(
            pose=self.pose,
            tool_angle_rad=np.array(angles)[order],
            joints_rad=np.array(states)[order].reshape(-1, 4, 3),
            contacts=np.zeros((len(angles), len(self.grip.contacts), 4)),
            torque_nmm=np.zeros(len(angles)),
            tip_force_n=np.zeros(len(angles)),
            hand_in_tool=self.hand_in_tool,
            end_minus="max_turn",
            end_plus="max_turn",
        )

    @property
    def _initial(self):
        assert self.spec.initial is not None
        return self.spec.initial

    def _linearized(self, tool_angle: float, joints: Array) -> tuple[Array, Array]:
        nudges = 1e-5 * np.eye(12)
        around = np.vstack([joints, joints + nudges, joints - nudges])
        gaps = self.grip.gaps(around, np.full(25, tool_angle))
        return gaps[0], (gaps[1:13] - gaps[13:]).T / 2e-5


def mechanism(pose: str, **joint_limits_deg: tuple[float, float]) -> Mechanism:
    """A pose of clay, with other joint limits where they are given [deg]."""
    spec = load_spec(CLAY)
    limits = {**spec.hand.joint_limits_deg, **joint_limits_deg}
    hand = spec.hand.model_copy(update={"joint_limits_deg": limits})
    return Mechanism(spec.model_copy(update={"hand": hand}), pose)
