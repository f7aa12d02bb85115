"""Quintic Hermite segments: position, velocity and acceleration given at both ends."""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Columns: p0, h v0, h^2 a0, p1, h v1, h^2 a1; rows: coefficients of s^0 .. s^5 for s in [0, 1].
_HERMITE = np.array(
    [
        [1, 0, 0, 0, 0, 0],
        [0, 1, 0, 0, 0, 0],
        [0, 0, 0.5, 0, 0, 0],
        [-10, -6, -1.5, 10, -4, 0.5],
        [15, 8, 1.5, -15, 7, -1],
        [-6, -3, -0.5, 6, -3, 0.5],
    ]
)


@dataclass(frozen=True)
class Knots:
    """Where n joints are at N times; the motion between two knots is a quintic."""

    time_s: Array  # (N,) strictly increasing
    position: Array  # (N, n) [rad]
    velocity: Array  # (N, n) [rad/s]
    acceleration: Array  # (N, n) [rad/s^2]
    preload: Array | None = None
    """(N, n) [rad] that the motors' goals lie beyond the position, linear between knots."""


@dataclass(frozen=True)
class Motion:
    """Position [rad], velocity [rad/s] and acceleration [rad/s^2] at M times, each (M, n)."""

    position: Array
    velocity: Array
    acceleration: Array


def segment_coefficients(knots: Knots) -> Array:
    """Polynomials (N - 1, 6, n) of all segments in s = (t - t_i) / (t_{i+1} - t_i)."""
    h = np.diff(knots.time_s)[:, None]
    start, end = slice(None, -1), slice(1, None)
    data = np.stack(
        [
            knots.position[start],
            h * knots.velocity[start],
            h**2 * knots.acceleration[start],
            knots.position[end],
            h * knots.velocity[end],
            h**2 * knots.acceleration[end],
        ],
        axis=1,
    )
    return _HERMITE @ data


def evaluate(knots: Knots, time_s: Array) -> Motion:
    """Motion at times (M,) within the knots' span."""
    segment = np.clip(
        np.searchsorted(knots.time_s, time_s, side="right") - 1, 0, len(knots.time_s) - 2
    )
    h = np.diff(knots.time_s)[segment]
    s = (time_s - knots.time_s[segment]) / h
    return evaluate_polynomial(segment_coefficients(knots)[segment], s, h)


def preload_at(knots: Knots, time_s: Array) -> Array:
    """Preload (M, n) [rad] at times (M,): straight from knot to knot; zero where there is none."""
    if knots.preload is None:
        return np.zeros((len(time_s), knots.position.shape[1]))
    return np.stack([np.interp(time_s, knots.time_s, column) for column in knots.preload.T], axis=1)


def evaluate_polynomial(c: Array, s: Array, h: Array) -> Motion:
    """Motion of polynomials (M, 6, n) of segments that last h (M,) [s], at s (M,) in [0, 1]."""
    s, h = s[:, None], h[:, None]
    c0, c1, c2, c3, c4, c5 = (c[:, k] for k in range(6))
    return Motion(
        ((((c5 * s + c4) * s + c3) * s + c2) * s + c1) * s + c0,
        ((((5 * c5 * s + 4 * c4) * s + 3 * c3) * s + 2 * c2) * s + c1) / h,
        (((20 * c5 * s + 12 * c4) * s + 6 * c3) * s + 2 * c2) / h**2,
    )


def extrema(coefficients: Array) -> tuple[float, float]:
    """Least and greatest value of one polynomial (k,) for s in [0, 1], ends included."""
    roots = polynomial.polyroots(polynomial.polytrim(polynomial.polyder(coefficients)))
    inner = roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real > 0) & (roots.real < 1)]
    values = polynomial.polyval(np.concatenate([[0.0, 1.0], inner]), coefficients)
    return float(values.min()), float(values.max())


def derivatives(c: Array, h: float) -> tuple[Array, Array, Array]:
    """Polynomials of position (6, n), velocity (5, n) and acceleration (4, n) of one segment."""
    velocity = np.arange(1.0, 6.0)[:, None] * c[1:] / h
    return c, velocity, np.arange(1.0, 5.0)[:, None] * velocity[1:] / h


def hull(c: Array) -> tuple[Array, Array]:
    """Bounds (n,), (n,) of polynomials (k, n) for s in [0, 1]; sure, but not sharp.

    A polynomial lies in the hull of its Bernstein coefficients.
    """
    bernstein = _BERNSTEIN[len(c) - 1] @ c
    return bernstein.min(axis=0), bernstein.max(axis=0)


def _power_to_bernstein(degree: int) -> Array:
    matrix = np.zeros((degree + 1, degree + 1))
    for i in range(degree + 1):
        for k in range(i + 1):
            matrix[i, k] = comb(i, k) / comb(degree, k)
    return matrix


_BERNSTEIN = {degree: _power_to_bernstein(degree) for degree in (3, 4, 5)}
