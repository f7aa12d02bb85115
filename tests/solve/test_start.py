"""Random starts lie inside all bounds, and the hand fits the tool as well as a rigid one can."""

from __future__ import annotations

import numpy as np
import pytest

from fpcad.solve.attempt import Workbench, solve_pose
from fpcad.solve.program import pose_bounds
from fpcad.solve.start import NORMAL_LENGTH_MM, random_start
from tests.model.plain_hand import Array

POSES = ("carve", "poke", "press")
SEEDS = range(5)


def start(bench: Workbench, pose: str, design: Array, seed: int) -> Array:
    return random_start(bench, pose, design, np.random.default_rng(seed))


def misfit(bench: Workbench, pose: str, design: Array, y: Array) -> float:
    """Sum of squares [mm^2] of gaps and of normals that are not opposed."""
    six = bench.kernels[pose].residual(design, 0.0, y)[0].reshape(-1, 6)
    return float((six[:, :3] ** 2).sum() + NORMAL_LENGTH_MM**2 * (six[:, 3:] ** 2).sum())


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("pose", POSES)
class TestStarts:
    def test_joints_and_contacts_are_inside_their_bounds(
        self, bench: Workbench, first_hand, pose: str, seed: int
    ):
        layout = bench.kernels[pose].layout
        lower, upper = pose_bounds(bench.spec, pose, layout)
        y = start(bench, pose, first_hand.design, seed)
        for part in (layout.joints, layout.contacts):
            assert (y[part] >= lower[part]).all() and (y[part] <= upper[part]).all()

    def test_contacts_are_on_the_far_part_of_their_links(
        self, bench: Workbench, first_hand, pose: str, seed: int
    ):
        d1, d4 = first_hand.design[[0, 3]]
        y = start(bench, pose, first_hand.design, seed)
        arclength = y[bench.kernels[pose].layout.contacts].reshape(-1, 4)[:, 2]
        cylinder = d1 - d4 / 2
        assert (arclength >= 0.3 * cylinder).all()
        assert (arclength <= cylinder + 0.9 * np.pi / 4 * d4).all()

    def test_no_small_motion_of_the_hand_fits_better(
        self, bench: Workbench, first_hand, pose: str, seed: int
    ):
        design = first_hand.design
        y = start(bench, pose, design, seed)
        best, random = misfit(bench, pose, design, y), np.random.default_rng(seed)
        for _ in range(30):
            moved = y.copy()
            moved[:3] += random.normal(size=3) * 0.5
            moved[3:6] += random.normal(size=3) * 0.02
            assert misfit(bench, pose, design, moved) > best


@pytest.mark.parametrize("pose", POSES)
def test_starts_depend_on_the_seed_alone(bench: Workbench, first_hand, pose: str):
    one, again, other = (start(bench, pose, first_hand.design, seed) for seed in (3, 3, 4))
    assert np.array_equal(one, again)
    assert np.abs(one - other).max() > 0.1


def test_some_starts_end_in_the_pose(bench: Workbench, first_hand):
    """Carving from nothing, on the hand in the middle of the box."""
    starts = [start(bench, "carve", first_hand.design, seed) for seed in range(12)]
    solved = [solve_pose(bench, "carve", first_hand.design, y) for y in starts]
    found = [pose for pose in solved if pose is not None]
    assert len(found) >= 3
    assert all(pose.residual.acceptable for pose in found)
