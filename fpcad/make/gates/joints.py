"""Gate: the parts of one finger, and of its joint in the palm, move freely over the joints' limits."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from fpcad.make.gates.approach import closest_approach
from fpcad.make.gates.bodies import Body, body_poses
from fpcad.make.gates.bounds import box_gap, swept_box
from fpcad.make.gates.finding import Finding, Severity, point
from fpcad.make.gates.meeting import Overlap
from fpcad.make.gates.postures import STEP_RAD
from fpcad.model.geometry import HandGeometry
from fpcad.spec.hand import Hand
from fpcad.spec.templates import TEMPLATES
from fpcad.units import DEG_PER_RAD, RAD_PER_DEG

Array = NDArray[np.float64]

GATE = "joint"
TOLD_MM = 1.0
CHAIN = ("palm", "mcp", "proximal", "distal")
"""Links from the palm outwards; joint i lies between links i and i + 1."""


def joint_grid(hand: Hand, joint: str) -> Array:
    """Angles (n,) [rad] over a joint's limits, not more than two degrees apart, rest among them."""
    low, high = (angle * RAD_PER_DEG for angle in hand.joint_limits_deg[joint])
    rest = hand.rest_posture_deg[joint] * RAD_PER_DEG
    below, above = (1 + int(np.ceil(abs(end - rest) / STEP_RAD - 1e-9)) for end in (low, high))
    return np.concatenate([np.linspace(low, rest, below)[:-1], np.linspace(rest, high, above)])


def check_joints(bodies: Sequence[Body], geometry: HandGeometry, hand: Hand) -> list[Finding]:
    """Overlaps of a finger's own parts over all angles of the joints between them.

    Fingers are alike, so pairs within a finger are judged for the first one.
    """
    grids = [joint_grid(hand, joint) for joint in TEMPLATES[hand.template].joints]
    found: list[Finding] = []
    least: dict[str, tuple[float, str]] = {}
    for a, b, moving in _pairs(bodies, geometry):
        joints = _postures(hand, geometry, grids, moving)
        T_a, T_b = (body_poses(body, geometry, joints) for body in (a, b))
        between = f"{a.link} and {b.link}"
        gap, closest = least.setdefault(between, (TOLD_MM, "none closer"))
        if box_gap(swept_box(a, T_a), swept_box(b, T_b)) > gap:
            continue
        approach = closest_approach(a, T_a, b, T_b, gap)
        if approach.overlap is not None:
            degrees = joints[approach.posture, geometry.fingers.index(str(b.finger))] * DEG_PER_RAD
            found.append(_overlap(f"{a.name} and {b.name}", approach.overlap, degrees))
        elif approach.gap_mm < gap:
            gap, closest = approach.gap_mm, f"{a.name} and {b.name}"
        least[between] = gap, closest
    for between, (gap, closest) in least.items():
        text = f"{'more than ' if gap == TOLD_MM else ''}{gap:.2f} mm over the joints' limits"
        told = between if gap == TOLD_MM else closest
        found.append(Finding(GATE, Severity.FIGURE, told, gap, 0.0, "mm", text))
    return found


def _overlap(pair: str, overlap: Overlap, degrees: Array) -> Finding:
    volume = overlap.volume_mm3
    text = "they share {:.3g} mm^3 at flexion {:.0f}, abduction {:.0f}, IP {:.0f} deg".format(
        volume, *degrees
    )
    return Finding(GATE, Severity.ERROR, pair, volume, 0.0, "mm^3", text, point(overlap.at_mm))


def _pairs(
    bodies: Sequence[Body], geometry: HandGeometry
) -> Iterator[tuple[Body, Body, tuple[int, ...]]]:
    """Pairs of different links and the joints between them, without the finger against the palm.

    What a proximal or distal link may meet of the palm is no fault of a joint; see `reach.py` beside this file.
    """
    first = geometry.fingers[0]
    own = [body for body in bodies if body.finger == first]
    for a in own:
        for b in own:
            near, far = CHAIN.index(a.link), CHAIN.index(b.link)
            if near < far:
                yield a, b, tuple(range(near, far))
    for a in bodies:
        if a.finger is None:
            for b in bodies:
                if b.link == "mcp":
                    yield a, b, (0,)


def _postures(
    hand: Hand, geometry: HandGeometry, grids: Sequence[Array], moving: tuple[int, ...]
) -> Array:
    """Joint angles (N, n_fingers, 3) [rad]: every combination of the moving joints' angles."""
    combined = np.meshgrid(*[grids[i] for i in moving], indexing="ij")
    rest = [hand.rest_posture_deg[joint] * RAD_PER_DEG for joint in TEMPLATES[hand.template].joints]
    joints = np.tile(rest, (combined[0].size, len(geometry.fingers), 1))
    for place, values in zip(moving, combined, strict=True):
        joints[:, :, place] = values.reshape(-1, 1)
    return joints
