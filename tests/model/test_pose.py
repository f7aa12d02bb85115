"""Margins of contacts on the skin, and the cost of a pose, written out by hand."""

from __future__ import annotations

import numpy as np
import pytest

from fpcad.solve.attempt import Workbench
from tests.model.plain_hand import Posture
from tests.model.postures import random_posture

SEEDS = range(4)
POSES = ("carve", "poke", "press")
EDGE_MM, BEND_LIMIT = 1.0, np.radians(110)


def skin_margins(at: Posture) -> list[float]:
    """From the bend plane, which is cut into the palmar side only, to 0.9 of the way to the apex."""
    r = at.d[3] / 2
    margins = []
    for _, _, s, phi in at.a:
        start = r * max(np.cos(phi), 0.0) * np.tan(BEND_LIMIT / 2) + EDGE_MM
        margins += [s - start, at.d[0] - r + 0.9 * r * np.pi / 2 - s]
    return margins


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("pose", POSES)
def test_contacts_keep_from_the_ends_of_the_skin(bench: Workbench, pose: str, seed: int):
    at = random_posture(bench.spec, pose, seed)
    _, _, skin, _ = bench.kernels[pose].residual(at.d, at.turn, at.y)
    assert np.allclose(skin, skin_margins(at))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("pose", POSES)
def test_opposition_is_the_cosine_less_its_least_value(bench: Workbench, pose: str, seed: int):
    at = random_posture(bench.spec, pose, seed)
    _, opposition, _, _ = bench.kernels[pose].residual(at.d, at.turn, at.y)
    cosines = [-at.tool(i).normal @ at.finger(i).normal for i in range(len(at.fingers))]
    assert np.allclose(opposition, np.array(cosines) - 0.5)


def cost(bench: Workbench, pose: str, at: Posture) -> float:
    residuals = bench.kernels[pose].constraints(at.d, at.turn, at.y)[0]
    return float(residuals @ residuals)


def rest_cost(at: Posture) -> float:
    """Abduction of all fingers, and the pull of the free ones to the straight posture."""
    free = [
        i
        for i, finger in enumerate(("thumb", "index", "middle", "ring"))
        if finger not in at.fingers
    ]
    return float(0.1 * (at.u[:, 1] ** 2).sum() + 0.01 * (at.u[free] ** 2).sum())


@pytest.mark.parametrize("seed", SEEDS)
def test_carving_costs_normals_along_the_turning_axis(bench: Workbench, seed: int):
    at = random_posture(bench.spec, "carve", seed)
    wasted = sum(at.finger(i).normal[2] ** 2 for i in (1, 2))  # index and middle
    assert cost(bench, "carve", at) == pytest.approx(wasted + rest_cost(at))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("pose", ["poke", "press"])
def test_pinching_costs_normals_that_are_not_opposed(bench: Workbench, pose: str, seed: int):
    at = random_posture(bench.spec, pose, seed)
    both = at.finger(0).normal + at.finger(1).normal  # thumb and middle
    assert cost(bench, pose, at) == pytest.approx(both @ both / 2 + rest_cost(at))
