"""Does a hand still wield its tool when the printer and the joints err? docs/checks.md, "Errors"."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fpcad.make.carried import moved_hands, registered, tool_ends, tool_frames
from fpcad.make.gates.bodies import link_poses
from fpcad.make.grip import ContactLink, link_axis, segment_distance
from fpcad.model.equilibrium import least_torque
from fpcad.model.geometry import hand_geometry
from fpcad.solve.attempt import Workbench
from fpcad.spec.schema import Spec
from fpcad.units import DEG_PER_RAD, RAD_PER_DEG
from fpcad.wield.evaluate import build_load
from fpcad.wield.path import WieldingPath
from fpcad.wield.touch import nearest_contacts

Array = NDArray[np.float64]

DRAWS, SEED = 50, 1
RADIUS_MM, JOINT_RAD = 0.3, 2.0 * RAD_PER_DEG
STEP_RAD = 10.0 * RAD_PER_DEG
"""Of each path so many states are tried: the pose, the ends, and one about every ten degrees."""


@dataclass(frozen=True)
class Survival:
    """One pose's path under errors."""

    tmr_deg: float
    """Without errors, on the states that are tried."""
    tmr_median_deg: float
    tmr_p5_deg: float
    """Exceeded by 95 % of the draws."""
    held_share: float
    """Share of the draws in which the tool is held at the pose and turned at all."""
    contact_error_median_mm: float
    """Largest gap or penetration of a draw, the tool left where it should be; median over the draws."""
    contact_error_max_mm: float
    tip_shift_median_mm: float
    """How far the tool's tip is carried along in a draw at most; median over the draws."""


def survival(
    bench: Workbench, design: Array, paths: Iterable[WieldingPath], draws: int = DRAWS
) -> dict[str, dict[str, Any]]:
    """Every pose's path, followed with the commanded joints by hands that are a little wrong.

    Each draw has one radius error for all skins (a printer's error is the same on like parts) and
    an offset of each joint, both uniform. Contacts stick, and fingertips are soft alike in all
    directions: so the tool goes where its contact points are nearest to the fingers' in the mean
    square. The path holds as far from the pose as no contact opens by more than the grip's squeeze,
    contacts stay on skins and tool, and friction holds the tip force.

    Args:
        design: (n_d,) [mm, rad].
        paths: the hand's paths.
        draws: how many wrong hands.
    """
    return {path.pose: asdict(_survival(bench, design, path, draws)) for path in paths}


def _survival(bench: Workbench, design: Array, path: WieldingPath, draws: int) -> Survival:
    rng = np.random.default_rng(SEED)
    kept = _kept(path.tool_angle_rad)
    touched = path.contacts[kept]
    joints = path.joints_rad[kept].reshape(len(kept), -1)
    angles = path.tool_angle_rad[kept]
    ranges, errors, shifts = [], [], []
    for draw in range(draws + 1):  # the first one is the hand without errors
        radius = rng.uniform(-RADIUS_MM, RADIUS_MM) if draw else 0.0
        offset = rng.uniform(-JOINT_RAD, JOINT_RAD, joints.shape[1]) if draw else 0.0
        wrong = _wider(bench, design, radius)
        trial = _Trial(bench, path, wrong, radius)
        held, error, shift = trial.follow(joints + offset, joints, angles, touched)
        ranges.append(_range_deg(angles, held))
        errors.append(error)
        shifts.append(shift)
    drawn = np.array(ranges[1:])
    return Survival(
        tmr_deg=ranges[0],
        tmr_median_deg=float(np.median(drawn)),
        tmr_p5_deg=float(np.quantile(drawn, 0.05)),
        held_share=float(np.mean(drawn > 0)),
        contact_error_median_mm=float(np.median(errors[1:])),
        contact_error_max_mm=float(np.max(errors[1:])),
        tip_shift_median_mm=float(np.median(shifts[1:])),
    )


class _Trial:
    """One hand, perhaps a wrong one, that is told to follow a path."""

    def __init__(
        self, bench: Workbench, path: WieldingPath, design: Array, swell_mm: float
    ) -> None:
        pose = bench.spec.poses[path.pose]
        self.bench, self.path, self.design, self.swell_mm = bench, path, design, swell_mm
        self.geometry = geometry = hand_geometry(bench.template, design)
        self.turning, self.tool = pose.turning, bench.spec.tool
        self.contacts = [ContactLink(c.finger, c.link) for c in pose.contacts]
        self.load = build_load(bench.spec, path.pose)
        self.squeeze_mm = squeeze_mm(bench.spec, geometry.distal_length_mm)

    def follow(
        self, wrong: Array, right: Array, angles: Array, touched: Array
    ) -> tuple[NDArray[np.bool_], float, float]:
        """What becomes of N states.

        Args:
            wrong: (N, n_u) joints where they are [rad].
            right: (N, n_u) joints where they should be.
            angles: (N,) tool angle [rad].
            touched: (N, n, 4) contact coordinates where they should be.

        Returns:
            Which states (N,) hold; the largest contact error [mm]; the tip's largest shift [mm].
        """
        asked = np.tile(self.path.hand_in_tool, (len(angles), 1))
        error = float(np.abs(self.gaps(asked, wrong, angles)).max())
        hands = self.carried(asked, wrong, right, angles, touched)
        touch = self.gaps(hands, wrong, angles).max(axis=1) <= self.squeeze_mm
        tips = (tool_ends(self.tool, self.turning, h, angles)[1] for h in (hands, asked))
        shift = float(np.linalg.norm(np.subtract(*tips), axis=1).max())
        states = zip(touch, hands, wrong, angles, strict=True)
        held = np.array([ok and self._holds(h, u, float(turn)) for ok, h, u, turn in states])
        return held, error, shift

    def carried(
        self, hands: Array, wrong: Array, right: Array, angles: Array, touched: Array
    ) -> Array:
        """Poses (N, 6) of H in O of the tool that fingers at wrong joints carry along."""
        points, normals = self._touching(hands, angles, touched)
        moved = np.empty_like(points)
        for i, contact in enumerate(self.contacts):
            T_right, T_wrong = (self._link(contact, joints) for joints in (right, wrong))
            motion = T_wrong @ np.linalg.inv(T_right)
            swollen = points[:, i] + self.swell_mm * normals[:, i]
            moved[:, i] = np.einsum("nij,nj->ni", motion[:, :3, :3], swollen) + motion[:, :3, 3]
        return moved_hands(hands, *registered(points, moved))

    def _touching(self, hands: Array, angles: Array, touched: Array) -> tuple[Array, Array]:
        """Contact points (N, n, 3) [mm] in H and the links' outward normals there."""
        R, origin = tool_frames(self.turning, hands, angles)
        axial, phi, zero = touched[..., 0], touched[..., 1], np.zeros_like(touched[..., 0])
        outward = np.stack([zero, np.cos(phi), np.sin(phi)], axis=-1)
        local = np.stack([axial, zero, zero], axis=-1) + self.tool.radius_mm * outward
        return np.einsum("nij,nkj->nki", R, local) + origin[:, None], -np.einsum(
            "nij,nkj->nki", R, outward
        )

    def _link(self, contact: ContactLink, joints: Array) -> Array:
        first = 3 * self.geometry.fingers.index(contact.finger)
        own = joints[:, first : first + 3]
        return link_poses(self.geometry, contact.finger, contact.link, own)

    def gaps(self, hands: Array, joints: Array, angles: Array) -> Array:
        """Gaps (N, n) [mm] of the contacting links to the tool, for poses (N, 6) of H in O."""
        back, tip = tool_ends(self.tool, self.turning, hands, angles)
        reach = self.geometry.radius_mm + self.tool.radius_mm
        axes = (link_axis(self.geometry, contact, joints) for contact in self.contacts)
        return np.stack([segment_distance(*axis, back, tip) - reach for axis in axes], axis=1)

    def _holds(self, hand: Array, joints: Array, turn: float) -> bool:
        name, design = self.path.pose, self.design
        contacts = nearest_contacts(self.bench, name, design, hand, turn, joints)
        if not self._on_skin(contacts):
            return False
        x, load = np.concatenate([joints, contacts.ravel()]), self.load
        kernels = self.bench.kernels[name]
        wrench, torque, tip = (v.copy() for v in kernels.statics(design, hand, turn, x))
        pulls = (1.0, -1.0) if turn == 0.0 else (float(np.sign(turn)),)
        cap, facets = load.max_joint_torque_nmm, load.cone_facets
        return all(
            least_torque(wrench, torque, load.tip_force_n * pull * tip, cap, facets) is not None
            for pull in pulls
        )

    def _on_skin(self, contacts: Array) -> bool:
        """Whether contacts (n, 4) lie on the tool and on the skins, not at their cut ends."""
        axial, arc, phi = contacts[:, 0], contacts[:, 2], contacts[:, 3]
        on_tool = (axial >= self.tool.back_mm) & (axial <= self.tool.tip_mm)
        bend = np.tan(self.bench.template.bend_limit / 2)
        edge = self.geometry.radius_mm * np.maximum(np.cos(phi), 0.0) * bend
        distal = np.array([contact.link == "distal" for contact in self.contacts])
        end = np.where(distal, np.inf, self.geometry.proximal_length_mm - edge)
        return bool(np.all(on_tool & np.where(distal, arc >= edge, arc <= end)))


def squeeze_mm(spec: Spec, distal_length_mm: float) -> float:
    """How far a fingertip springs after the tool [mm]: the least grip force over its stiffness.

    The stiffness is that of the IP joint's tendon, the softest spring between motor and tip.
    """
    strand = spec.grip.tendon_stiffness_n / spec.grip.tendon_length_mm
    lever = spec.motors.transmission.ip_pulley_radius_mm / distal_length_mm
    return spec.grip.min_normal_force_n / (strand * lever**2)


def _wider(bench: Workbench, design: Array, radius_mm: float) -> Array:
    """The design with another finger radius."""
    wrong = design.copy()
    wrong[bench.template.names.parameters.index("d4_finger_diameter_mm")] += 2 * radius_mm
    return wrong


def _kept(angles: Array) -> NDArray[np.int64]:
    """Numbers of states about STEP_RAD apart, the pose and both ends among them."""
    ends = angles[0], angles[-1]
    counts = [1 + int(np.ceil(abs(end) / STEP_RAD)) for end in ends]
    below, above = (np.linspace(0.0, end, n) for end, n in zip(ends, counts, strict=True))
    wanted = np.concatenate([below, above])
    return np.unique(np.abs(angles[:, None] - wanted).argmin(axis=0))


def _range_deg(angles: Array, held: NDArray[np.bool_]) -> float:
    """Range [deg] around the pose that holds without a gap."""
    pose = int(np.argmin(np.abs(angles)))
    if not held[pose]:
        return 0.0
    above = pose + int(np.argmin(np.append(held[pose:], False)))
    below = pose - int(np.argmin(np.append(held[pose::-1], False)))
    return float(angles[above - 1] - angles[below + 1]) * DEG_PER_RAD


def told(figures: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """The figures in words, a line for each pose."""
    return [
        f"{pose}: {f['tmr_deg']:.0f} deg without errors; with {RADIUS_MM:g} mm on the radius and "
        f"{JOINT_RAD * DEG_PER_RAD:.0f} deg on the joints {f['tmr_median_deg']:.0f} deg in the median, "
        f"held in {100 * f['held_share']:.0f} % of {DRAWS} draws"
        for pose, f in figures.items()
    ]
