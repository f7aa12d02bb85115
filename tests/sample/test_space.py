"""The standardized design space."""

from __future__ import annotations

import numpy as np
import pytest

from fpcad.sample.space import DesignSpace, design_space
from fpcad.spec.schema import Spec

HELD = DesignSpace(("a_mm", "b_deg", "c_mm"), np.array([10.0, -60, 3]), np.array([30.0, 60, 3]))


def test_the_box_becomes_the_unit_cube_about_zero():
    assert HELD.standardize(np.array([10.0, -60, 3])).tolist() == [-0.5, -0.5]
    assert HELD.standardize(np.array([30.0, 60, 3])).tolist() == [0.5, 0.5]
    assert HELD.standardize(np.array([20.0, 0, 3])).tolist() == [0, 0]


def test_held_parameters_keep_their_value():
    assert HELD.free.tolist() == [True, True, False]
    assert HELD.named(np.array([0.25, -0.25])).tolist() == [25, -30, 3]


@pytest.mark.parametrize("seed", range(5))
def test_standardizing_and_naming_are_inverse(clay: Spec, seed: int):
    for space in (design_space(clay.hand), HELD):
        points = np.random.default_rng(seed).uniform(-0.5, 0.5, (7, int(space.free.sum())))
        named = space.named(points)
        assert (named >= space.lower).all() and (named <= space.upper).all()
        assert np.allclose(space.standardize(named), points, atol=1e-14)
        assert np.allclose(space.named(space.standardize(named)), named, atol=1e-12)


def test_many_designs_are_treated_as_each_one(clay: Spec):
    space = design_space(clay.hand)
    points = np.random.default_rng(0).uniform(-0.5, 0.5, (4, 6))
    assert np.array_equal(space.named(points), [space.named(point) for point in points])


def test_mechanics_get_radians():
    assert HELD.internal(np.array([25.0, 180.0, 3.0])).tolist() == [25, np.pi, 3]


def test_ranges_are_the_specs(clay: Spec):
    space = design_space(clay.hand)
    assert space.names[0] == "d1_distal_length_mm"
    assert space.lower.tolist() == [30, 50, 20, 12, 30, -60]
    assert space.upper.tolist() == [55, 120, 40, 20, 120, 60]
