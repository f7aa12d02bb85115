"""Whether a segment of motion stays within the limits from end to end, not at its knots only."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.run.limits import JointLimits
from fpcad.run.messages import Reason
from fpcad.run.quintic import Knots, derivatives, extrema, hull, segment_coefficients

Array = NDArray[np.float64]

_COUNT = 1e-6
"""Resolution of the wire [rad, rad/s, rad/s^2]."""


@dataclass(frozen=True)
class Violation:
    """One joint that leaves one limit; value and limit in rad, rad/s or rad/s^2."""

    reason: Reason
    joint: int
    time_s: float
    value: float
    limit: float


def first_violation(
    knots: Knots, limits: JointLimits, counts: Array | float = 1.0
) -> Violation | None:
    """First segment of the knots (N, n) that leaves the limits, if any.

    `counts`: of how many counts the rounding of the numbers may be, for each (n,) or for all.
    """
    steps = np.diff(knots.time_s)
    for start, step, c in zip(knots.time_s, steps, segment_coefficients(knots), strict=False):
        violation = _segment_violation(c, float(step), float(start), limits, counts)
        if violation is not None:
            return violation
    return None


def _segment_violation(
    c: Array, step_s: float, start_s: float, limits: JointLimits, counts: Array | float
) -> Violation | None:
    position, velocity, acceleration = derivatives(c, step_s)
    bounds = (
        (Reason.POSITION_LIMIT, position, limits.lower_rad, limits.upper_rad),
        (Reason.VELOCITY_LIMIT, velocity, -limits.velocity_rad_s, limits.velocity_rad_s),
        (
            Reason.ACCELERATION_LIMIT,
            acceleration,
            -limits.acceleration_rad_s2,
            limits.acceleration_rad_s2,
        ),
    )
    for (reason, polynomials, lower, upper), one in zip(bounds, _rounding(step_s), strict=True):
        slack = np.broadcast_to(one * counts, lower.shape)
        low, high = hull(polynomials)
        # The hull is cheap and sure; only where it is too wide do the exact extrema decide.
        for joint in np.flatnonzero((low < lower - slack) | (high > upper + slack)):
            least, greatest = extrema(polynomials[:, joint])
            if least < lower[joint] - slack[joint]:
                return Violation(reason, int(joint), start_s, least, float(lower[joint]))
            if greatest > upper[joint] + slack[joint]:
                return Violation(reason, int(joint), start_s, greatest, float(upper[joint]))
    return None


def _rounding(step_s: float) -> tuple[float, float, float]:
    """How far rounding knots to counts can move a segment's position, velocity, acceleration.

    Half a count at both ends in each of the three numbers, times the largest value of the
    Hermite basis functions' derivatives, rounded up; and as much for the limit itself.
    """
    return (
        _COUNT * (2 + step_s),
        _COUNT * (2 / step_s + 2 + step_s),
        _COUNT * (6 / step_s**2 + 6 / step_s + 2),
    )
