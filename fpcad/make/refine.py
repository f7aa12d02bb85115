"""A smooth curve of contact postures over the tool's turn, from the states of a wielding path.

A path has kinks where a joint limit or a contact bound engages. A guide spline rounds them within
the path's own range, and each knot of the curve is the exact contact posture nearest to the guide.
docs/trajectories.md, "From states to a curve", tells why.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BPoly, BSpline, PchipInterpolator

from fpcad.errors import MakeError
from fpcad.make.grip import Grip
from fpcad.wield.path import WieldingPath

Array = NDArray[np.float64]
Project = Callable[[float, Array], Array]
"""(tool angle [rad], joints (n,) [rad]) -> nearest joints (n,) [rad] in exact contact."""

CURVE_GAP_MM = 0.002
"""Gap beyond which a segment of the curve is split."""
MAX_SPLITS = 12
"""How often a segment may be halved: down to a few millionths of a radian at a kink."""


@dataclass(frozen=True)
class Leg:
    """One direction of a path, from the pose to the end; n >= 2 states."""

    direction: float
    """+1 or -1: sign of the tool's angle."""
    turn: Array
    """(n,) magnitude of the tool's angle [rad], from 0 up."""
    joints: Array
    """(n, n_joints) [rad]."""


@dataclass(frozen=True)
class ContactCurve:
    """Joints over the tool's turn along one leg: twice differentiable, in contact throughout."""

    length: float
    """Turn [rad] at the end."""
    cell: float
    """Spacing [rad] of the guide's knots."""
    joints: BPoly
    """Quintics over the turn [rad]: joints (n_joints,) [rad]."""

    def at(self, turn: Array) -> tuple[Array, Array, Array]:
        """Joints and their first and second derivatives by the turn, (N, n_joints) each."""
        return self.joints(turn), self.joints(turn, 1), self.joints(turn, 2)


def legs(path: WieldingPath) -> list[Leg]:
    """The plus and the minus leg of a path, as far as it has them."""
    at_pose = np.flatnonzero(path.tool_angle_rad == 0.0)
    if len(at_pose) != 1:
        raise ValueError(f"path of {path.pose}: {len(at_pose)} states at tool angle 0, not one")
    pose = int(at_pose[0])
    joints = path.joints_rad.reshape(len(path.tool_angle_rad), -1)
    both = [
        Leg(1.0, path.tool_angle_rad[pose:], joints[pose:]),
        Leg(-1.0, -path.tool_angle_rad[pose::-1], joints[pose::-1]),
    ]
    return [leg for leg in both if len(leg.turn) > 1]


def contact_curve(leg: Leg, grip: Grip, project: Project, limits: Array) -> ContactCurve:
    """Curve through exact contact postures, refined until it keeps contact and limits throughout.

    Args:
        leg: states of the path.
        grip: measures the gaps.
        project: gives the exact contact posture nearest to a guess.
        limits: (2, n_joints) least and greatest joint angles [rad].

    Raises:
        MakeError: contact cannot be kept, however fine the knots.
    """
    guide = guide_spline(leg)
    knots = np.unique(guide.t)
    cell = float(knots[1] - knots[0])
    inner = _projected(leg, guide, project, grip, knots[1:-1])
    exact = np.vstack([leg.joints[0], inner, leg.joints[-1]])
    for _ in range(MAX_SPLITS):
        curve = _through(knots, exact, guide, limits)
        middles = _faulty_middles(curve, knots, leg, grip)
        if not len(middles):
            return ContactCurve(float(knots[-1]), cell, curve)
        order = np.argsort(np.concatenate([knots, middles]), kind="stable")
        exact = np.concatenate([exact, _projected(leg, guide, project, grip, middles)])[order]
        knots = np.concatenate([knots, middles])[order]
    raise _lost(leg, middles[0], "no smooth motion keeps contact")


def limit_excess(joints: Array, limits: Array, leg: Leg) -> Array:
    """By how much states (N, n_joints) pass the limits (2, n_joints), (N,) [rad].

    A path keeps limits to its solver's tolerance; where its own states pass them, they count.
    """
    low, high = np.minimum(limits[0], leg.joints.min(0)), np.maximum(limits[1], leg.joints.max(0))
    return np.maximum(low - joints, joints - high).max(axis=1)


def guide_spline(leg: Leg) -> BSpline:
    """Cubic spline near a leg's states: exact at both ends, kinks rounded over about two cells.

    Its coefficients are values of the path (Schoenberg's operator), so it stays in their range:
    where a joint rests at its limit, so does the guide.
    """
    turn = leg.turn
    cells = max(2, int(np.ceil(turn[-1] / np.diff(turn).max() - 1e-9)))
    breaks = np.linspace(0.0, turn[-1], cells + 1)
    knots = np.concatenate([[0.0] * 3, breaks, [turn[-1]] * 3])
    greville = np.clip((knots[1:-3] + knots[2:-2] + knots[3:-1]) / 3, 0.0, turn[-1])
    return BSpline(knots, PchipInterpolator(turn, leg.joints)(greville), 3)


def _projected(leg: Leg, guide: BSpline, project: Project, grip: Grip, turns: Array) -> Array:
    """Exact postures (N, n_joints) at the turns; splitting cannot mend what is wrong with them."""
    states = [project(float(leg.direction * turn), guide(turn)) for turn in turns]
    states = np.reshape(states, (len(turns), leg.joints.shape[1]))
    wrong = grip.errors(states, leg.direction * turns) > CURVE_GAP_MM
    if wrong.any():
        raise _lost(
            leg, turns[wrong][0], "the posture next to the path is not in contact, or in the tool"
        )
    return states


def _lost(leg: Leg, turn: float, what: str) -> MakeError:
    return MakeError(f"{what} at a tool angle of {np.degrees(leg.direction * turn):.2f} deg")


def _through(knots: Array, exact: Array, guide: BSpline, limits: Array) -> BPoly:
    """Quintics with the guide's derivatives plus those of the corrections' local parabolas."""
    first, second = _parabola_derivatives(knots, exact - guide(knots))
    first, second = _kept_within(
        limits, knots, exact, guide(knots, 1) + first, guide(knots, 2) + second
    )
    return BPoly.from_derivatives(knots, np.stack([exact, first, second], axis=1))


def _kept_within(
    limits: Array, knots: Array, exact: Array, first: Array, second: Array
) -> tuple[Array, Array]:
    """Derivatives as near to the given ones as the limits allow between the knots too.

    A quintic whose Bernstein coefficients keep a limit keeps it. Next to a knot at a distance y
    from a limit they are y + 2/5 h y' and y + 2/5 h y' + h^2 y''/20, on both sides (h of either
    sign), beside one that lies between y and the first of the two. docs/trajectories.md.
    """
    step = np.diff(knots)[:, None]
    after, before = np.vstack([step, step[-1:]]), np.vstack([step[:1], step])
    low = np.maximum(exact - limits[0], 0.0)
    high = np.maximum(limits[1] - exact, 0.0)
    first = np.clip(
        first,
        -2.5 * np.minimum(low / after, high / before),
        2.5 * np.minimum(low / before, high / after),
    )
    rise, fall = 0.4 * after * first, 0.4 * before * first
    least = -20 * np.minimum((low + rise) / after**2, (low - fall) / before**2)
    most = 20 * np.minimum((high - rise) / after**2, (high + fall) / before**2)
    return first, np.clip(second, np.minimum(least, 0.0), np.maximum(most, 0.0))


def _parabola_derivatives(x: Array, y: Array) -> tuple[Array, Array]:
    """First and second derivative at each knot of the parabola through it and its neighbours.

    Three points at a time, so that a joint at rest at its limit gets zeros and no ringing.
    """
    step = np.diff(x)[:, None]
    slope = np.diff(y, axis=0) / step
    second = 2 * np.diff(slope, axis=0) / (step[1:] + step[:-1])
    first = (step[:-1] * slope[1:] + step[1:] * slope[:-1]) / (step[1:] + step[:-1])
    start = first[0] - second[0] * step[0]
    end = first[-1] + second[-1] * step[-1]
    return np.vstack([start, first, end]), np.vstack([second[:1], second, second[-1:]])


def _faulty_middles(curve: BPoly, knots: Array, leg: Leg, grip: Grip) -> Array:
    """Middles of the segments that lose contact, or let something else into the tool."""
    inside = np.linspace(0.0, 1.0, 9)[1:-1]
    turns = (knots[:-1, None] + np.diff(knots)[:, None] * inside).ravel()
    joints = curve(turns)
    faulty = grip.errors(joints, leg.direction * turns) > CURVE_GAP_MM
    segments = faulty.reshape(-1, len(inside)).any(axis=1)
    return (knots[:-1] + knots[1:])[segments] / 2
