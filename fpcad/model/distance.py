"""Squared distance between two segments, exact and differentiable in degenerate cases too."""

from __future__ import annotations

from typing import NamedTuple

import casadi as ca

from fpcad.model.frames import Expr

PARALLEL_SINE_SQUARED = 1e-10
"""Below it two segments count as parallel: an end point then attains the minimum."""


class Segment(NamedTuple):
    """A straight segment; equal ends make a point."""

    start: Expr  # (3,) [mm]
    end: Expr  # (3,) [mm]


def segment_distance_squared(a: Segment, b: Segment) -> Expr:
    """Least squared distance [mm^2] between two segments, points included.

    The minimum is attained either between inner points, where both feet of the common normal lie
    inside, or at an end of one segment: five candidates, none of which divides by zero.
    """
    u, v, w = a.end - a.start, b.end - b.start, a.start - b.start
    uu, uv, vv = ca.dot(u, u), ca.dot(u, v), ca.dot(v, v)
    ends = ca.fmin(
        ca.fmin(_to_segment(a.start, b, vv), _to_segment(a.end, b, vv)),
        ca.fmin(_to_segment(b.start, a, uu), _to_segment(b.end, a, uu)),
    )
    normal = ca.cross(u, v)
    sine = ca.sumsqr(normal)  # of the angle, squared; uu * vv - uv^2 would lose its digits
    crossing = sine > PARALLEL_SINE_SQUARED * uu * vv
    safe = ca.if_else(crossing, sine, 1)
    uw, vw = ca.dot(u, w), ca.dot(v, w)
    s, t = (uv * vw - vv * uw) / safe, (uu * vw - uv * uw) / safe
    inside = ca.logic_and(crossing, ca.logic_and(ca.fmin(s, t) >= 0, ca.fmax(s, t) <= 1))
    inner = ca.dot(w, normal) ** 2 / safe
    return ca.if_else(inside, inner, ends)


def _to_segment(point: Expr, segment: Segment, length_squared: Expr) -> Expr:
    direction, offset = segment.end - segment.start, point - segment.start
    safe = ca.if_else(length_squared > 0, length_squared, 1)
    foot = ca.fmin(ca.fmax(ca.dot(offset, direction) / safe, 0), 1)
    return ca.sumsqr(offset - foot * direction)
