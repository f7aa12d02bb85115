import numpy as np
import pytest
from scipy.interpolate import BPoly

from fpcad.run.quintic import Knots, derivatives, evaluate, extrema, hull, segment_coefficients


def random_knots(seed, rows=6, joints=3):
    rng = np.random.default_rng(seed)
    return Knots(np.cumsum(rng.uniform(0.01, 0.3, rows)), *rng.normal(size=(3, rows, joints)))


@pytest.mark.parametrize("seed", range(10))
def test_agrees_with_scipy(seed):
    knots = random_knots(seed)
    reference = BPoly.from_derivatives(
        knots.time_s, np.stack([knots.position, knots.velocity, knots.acceleration], axis=1)
    )
    t = np.linspace(knots.time_s[0], knots.time_s[-1], 200)
    motion = evaluate(knots, t)
    np.testing.assert_allclose(motion.position, reference(t), atol=1e-11)
    np.testing.assert_allclose(motion.velocity, reference(t, 1), atol=1e-9)
    np.testing.assert_allclose(motion.acceleration, reference(t, 2), atol=1e-7)


def test_reproduces_a_polynomial_of_degree_five():
    p = np.polynomial.Polynomial([0.3, -1.0, 2.0, 0.7, -3.0, 1.1])
    t = np.array([0.0, 0.4, 1.0])
    rows = [p.deriv(k)(t)[:, None] if k else p(t)[:, None] for k in range(3)]
    fine = np.linspace(0, 1, 50)
    np.testing.assert_allclose(evaluate(Knots(t, *rows), fine).position[:, 0], p(fine), atol=1e-13)


@pytest.mark.parametrize("seed", range(20))
def test_extrema_lie_within_the_hull_and_are_sharp(seed):
    knots = random_knots(seed, rows=2)
    c = segment_coefficients(knots)[0]
    s = np.linspace(0, 1, 20_001)
    for polynomials in derivatives(c, float(np.diff(knots.time_s)[0])):
        low, high = hull(polynomials)
        for joint in range(polynomials.shape[1]):
            values = np.polynomial.polynomial.polyval(s, polynomials[:, joint])
            least, greatest = extrema(polynomials[:, joint])
            span = float(np.ptp(values))
            assert low[joint] <= least + 1e-9 * span and greatest <= high[joint] + 1e-9 * span
            assert least == pytest.approx(values.min(), abs=1e-6 * span)
            assert greatest == pytest.approx(values.max(), abs=1e-6 * span)


@pytest.mark.parametrize(
    "coefficients", [[2.0], [1.0, 0.0, 0.0], [0.0, 1.0], [0.0, 1.0, -1.0, 0.0]]
)
def test_extrema_of_degenerate_polynomials(coefficients):
    values = np.polynomial.polynomial.polyval(np.linspace(0, 1, 1001), np.array(coefficients))
    assert extrema(np.array(coefficients)) == pytest.approx((values.min(), values.max()), abs=1e-6)
