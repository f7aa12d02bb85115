"""Distance between segments against a search over one of them, degenerate pairs included."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from fpcad.model.distance import Segment, segment_distance_squared
from tests.model.plain_hand import Array

Pair = tuple[Array, Array, Array, Array]


def _function() -> ca.Function:
    ends = [ca.SX.sym(name, 3) for name in ("a0", "a1", "b0", "b1")]
    squared = segment_distance_squared(Segment(*ends[:2]), Segment(*ends[2:]))
    slope = ca.gradient(squared, ca.vertcat(*ends))
    return ca.Function("distance", ends, [squared, slope])


FUNCTION = _function()


def distance(pair: Pair) -> float:
    """What the model finds [mm]."""
    return float(np.sqrt(float(FUNCTION(*pair)[0])))


def searched(pair: Pair) -> float:
    """Distance [mm] by a search along the first segment: it is convex, and a point's is exact."""
    a0, a1, b0, b1 = pair

    def to_second(s: float) -> float:
        point, along = a0 + s * (a1 - a0), b1 - b0
        length = along @ along
        foot = b0 + (np.clip((point - b0) @ along / length, 0, 1) * along if length else 0.0)
        return float(np.linalg.norm(point - foot))

    found = minimize_scalar(
        to_second, bounds=(0.0, 1.0), method="bounded", options={"xatol": 1e-11}
    )
    return min(float(found.fun), to_second(0.0), to_second(1.0))  # type: ignore[attr-defined]


def near_parallel(angle: float, seed: int) -> Pair:
    """Two long segments side by side, 20 mm apart, whose directions differ by an angle."""
    random = np.random.default_rng(seed)
    x, y, z = np.linalg.qr(random.normal(size=(3, 3)))[0]
    start, shift = random.normal(size=3), random.uniform(-40, 60)
    along = np.cos(angle) * x + np.sin(angle) * y
    middle = start + 20 * z + shift * x
    return start, start + 80 * x, middle - 40 * along, middle + 50 * along


@pytest.mark.parametrize("seed", range(200))
def test_random_segments(seed: int):
    pair = tuple(np.random.default_rng(seed).uniform(-50, 50, (4, 3)))
    assert distance(pair) == pytest.approx(searched(pair), abs=1e-9)


@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("angle", [0.1, 1e-3, 1e-4, 2e-5, 1.1e-5, 0.9e-5, 1e-7, 0.0])
def test_nearly_parallel_segments(angle: float, seed: int):
    pair = near_parallel(angle, seed)
    assert distance(pair) == pytest.approx(searched(pair), abs=1e-8)


HERE, X, Y, Z = np.zeros(3), *(10.0 * np.eye(3))
DEGENERATE: dict[str, tuple[Pair, float]] = {
    "equal points": ((X, X, X, X), 0.0),
    "two points": ((HERE, HERE, X, X), 10.0),
    "point beside a segment": ((Y, Y, -X, X), 10.0),
    "point beyond a segment": ((3 * X, 3 * X, HERE, X), 20.0),
    "point on a segment": ((X / 2, X / 2, HERE, X), 0.0),
    "parallel, side by side": ((HERE, 2 * X, X + Y, 3 * X + Y), 10.0),
    "parallel, opposite ways": ((HERE, 2 * X, 3 * X + Y, X + Y), 10.0),
    "parallel, one inside the other's span": ((-3 * X, 3 * X, Y, X + Y), 10.0),
    "parallel, apart": ((HERE, X, 2 * X + Y, 3 * X + Y), np.sqrt(200)),
    "collinear, overlapping": ((HERE, 2 * X, X, 3 * X), 0.0),
    "collinear, apart": ((HERE, X, 3 * X, 4 * X), 20.0),
    "collinear, nested": ((HERE, 4 * X, X, 2 * X), 0.0),
    "equal": ((HERE, X, HERE, X), 0.0),
    "crossing": ((-X, X, -Y, Y), 0.0),
    "crossing above": ((-X, X, Z - Y, Z + Y), 10.0),
    "touching at ends": ((HERE, X, X, X + Y), 0.0),
    "touching at an end and a side": ((HERE, X, -Y, Y), 0.0),
    "end above a side": ((Z, 2 * Z, -Y, Y), 10.0),
}


@pytest.mark.parametrize("case", DEGENERATE)
def test_degenerate_segments(case: str):
    pair, expected = DEGENERATE[case]
    assert distance(pair) == pytest.approx(expected, abs=1e-12)
    assert np.isfinite(np.array(FUNCTION(*pair)[1])).all()


@pytest.mark.parametrize("case", DEGENERATE)
def test_order_and_direction_do_not_matter(case: str):
    (a0, a1, b0, b1), expected = DEGENERATE[case]
    for pair in ((b0, b1, a0, a1), (a1, a0, b0, b1), (a0, a1, b1, b0), (b1, b0, a1, a0)):
        assert distance(pair) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("seed", range(50))
def test_symmetry_of_random_segments(seed: int):
    a0, a1, b0, b1 = np.random.default_rng(seed).uniform(-50, 50, (4, 3))
    assert distance((a0, a1, b0, b1)) == pytest.approx(distance((b1, b0, a0, a1)), abs=1e-12)


@pytest.mark.parametrize("seed", range(50))
def test_gradient_is_the_slope(seed: int):
    ends = np.random.default_rng(seed).uniform(-50, 50, 12)

    def squared(at: Array) -> float:
        return float(FUNCTION(*at.reshape(4, 3))[0])

    steps = 1e-5 * np.eye(12)
    slope = [(squared(ends + step) - squared(ends - step)) / 2e-5 for step in steps]
    promised = np.array(FUNCTION(*ends.reshape(4, 3))[1]).ravel()
    assert np.allclose(promised, slope, atol=1e-5)


def test_gradient_has_no_jump_where_the_foot_reaches_an_end():
    """From the inside of a segment to its end point, distance and gradient are continuous."""
    before, behind = (
        (-X, X, Z + shift * X - Y, Z + shift * X + Y) for shift in (1 - 1e-9, 1 + 1e-9)
    )
    slopes = [np.array(FUNCTION(*pair)[1]).ravel() for pair in (before, behind)]
    assert np.allclose(*slopes, atol=1e-6)
