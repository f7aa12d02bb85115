"""Which solids must stay apart, and how far apart they are found to be."""

from __future__ import annotations

from itertools import combinations

import casadi as ca
import numpy as np
import pytest

from fpcad.model.collision import Pair
from fpcad.model.distance import Segment
from fpcad.model.pose import PoseModel
from fpcad.solve.attempt import Workbench
from fpcad.spec.schema import Spec
from tests.model.plain_hand import FINGERS, Array, Posture, hand_frame, link_frame
from tests.model.postures import random_posture

LINKS = [f"{finger}.{link}" for finger in FINGERS for link in ("proximal", "distal")]
SOLIDS = ["spine", "knuckles", "thumb_mcp", "index_mcp", "middle_mcp", "ring_mcp"]


def expected_pairs(touching: set[str]) -> set[str]:
    """Finger against finger, tool against what does not touch it, distal links against bars."""
    fingers = {f"{a}/{b}" for a, b in combinations(LINKS, 2) if a.split(".")[0] != b.split(".")[0]}
    tool = {f"tool/{link}" for link in LINKS if link not in touching}
    tool |= {f"tool/{solid}" for solid in SOLIDS}
    palm = {f"{finger}.distal/{bar}" for finger in FINGERS for bar in ("spine", "knuckles")}
    return fingers | tool | palm


@pytest.mark.parametrize("pose", ["carve", "poke", "press"])
def test_pairs_follow_from_who_touches(clay: Spec, pose: str):
    touching = {f"{c.finger}.{c.link}" for c in clay.poses[pose].contacts}
    names = [pair.name for pair in PoseModel(clay, pose).collision_pairs]
    assert len(names) == len(set(names))
    assert set(names) == expected_pairs(touching)


def segments(at: Posture) -> dict[str, tuple[Array, Array, float]]:
    """Axis ends in O and radius of every solid, by plain NumPy."""
    hand, r = hand_frame(at.h), at.d[3] / 2
    found = {}
    for finger, u in zip(FINGERS, at.u, strict=True):
        for link, length in (("proximal", 100 - at.d[0]), ("distal", at.d[0] - r)):
            frame = hand @ link_frame(finger, link, at.d, u)
            found[f"{finger}.{link}"] = (frame.p, frame.p + length * frame.R[:, 0], r)
    x, y, up = at.d[1] / 2, at.d[2], np.array([0.0, 0.0, 9.0])
    roots = {
        "thumb": np.array([-x, 0, 0]),
        "index": np.array([x, y, 0]),
        "middle": np.array([x, 0, 0]),
        "ring": np.array([x, -y, 0]),
    }
    palm = {"spine": ("thumb", "middle"), "knuckles": ("index", "ring")}
    for name, ends in palm.items():
        a, b = (hand.p + hand.R @ (roots[end] + up) for end in ends)
        found[name] = (a, b, 9.0)
    for finger, root in roots.items():
        centre = hand.p + hand.R @ (root + up / 3)
        found[f"{finger}_mcp"] = (centre, centre, 15.0)
    along = np.array([np.cos(at.turn), np.sin(at.turn), 0.0])
    found["tool"] = (-80 * along, 80 * along, 6.0)
    return found


def gap(a: tuple[Array, Array, float], b: tuple[Array, Array, float], points: int = 801) -> float:
    """Least gap [mm] between finely sampled axes, less the radii; never below the true one."""
    first = np.linspace(a[0], a[1], points)
    along = b[1] - b[0]
    length = max(along @ along, 1e-30)
    foot = np.clip((first - b[0]) @ along / length, 0, 1)
    return float(np.linalg.norm(first - b[0] - foot[:, None] * along, axis=1).min()) - a[2] - b[2]


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("pose", ["carve", "press"])
def test_clearances_are_those_of_sampled_axes(bench: Workbench, pose: str, seed: int):
    at = random_posture(bench.spec, pose, seed)
    solids = segments(at)
    *_, clearances = bench.kernels[pose].residual(at.d, at.turn, at.y)
    names = [pair.name.split("/") for pair in PoseModel(bench.spec, pose).collision_pairs]
    for (a, b), clearance in zip(names, clearances, strict=True):
        sampled = gap(solids[a], solids[b])
        assert clearance <= sampled + 1e-9
        assert sampled - clearance < 0.1


@pytest.mark.parametrize("distance", [20.0, 13.0, 5.0])
def test_margin_is_smooth_and_agrees_with_the_gap_at_contact(distance: float):
    apart = ca.DM([0, 0, distance])
    pair = Pair("a/b", Segment(ca.DM([-5, 0, 0]), ca.DM([5, 0, 0])), Segment(apart, apart), 13.0)
    assert float(pair.clearance()) == pytest.approx(distance - 13)
    assert float(pair.margin()) == pytest.approx((distance**2 - 169) / 26)


def test_margin_has_the_slope_of_the_gap_at_contact():
    z = ca.SX.sym("z")
    point = ca.vertcat(0, 0, z)
    pair = Pair("a/b", Segment(ca.DM([-5, 0, 0]), ca.DM([5, 0, 0])), Segment(point, point), 13.0)
    slopes = ca.Function(
        "s", [z], [ca.gradient(pair.margin(), z), ca.gradient(pair.clearance(), z)]
    )
    assert [float(slope) for slope in slopes(13.0)] == pytest.approx([1.0, 1.0])
