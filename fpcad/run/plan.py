"""What is asked of the joints: the file's motion, the way to its start, and the closing of the grip."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fpcad.run.driver import Sample
from fpcad.run.errors import LimitsError, StartTooFar
from fpcad.run.knots import approach, from_wire, to_wire
from fpcad.run.limits import PRELOAD_LIMIT_RAD, PRELOAD_SPEED_RAD_S, JointLimits
from fpcad.run.quintic import Knots
from fpcad.run.trajectory import in_order, read_trajectory, repeated, require_within, slowed

Array = NDArray[np.float64]

START_DISTANCE_RAD = float(np.radians(2.0))
"""Way to the start that a run takes unasked."""
OUTSIDE_RAD = float(np.radians(0.25))
"""How far beyond its limit a resting joint may be seen: encoders have steps of 0.09 degrees."""
APPROACH_SHARE = 0.2
"""Part of the limits that the way to the start may use."""
CLOSING_RAD_S = 0.25
"""How fast the grip closes."""
_SHORTEST_CLOSING_S = 0.2


def planned(trajectory_file: Path, limits: JointLimits, speed: float, loops: int) -> Knots:
    """The file's motion in the controller's order, checked as it will be sent."""
    once = slowed(in_order(read_trajectory(trajectory_file), limits), speed)
    _require_preload(once, limits)
    whole = repeated(once, loops)
    # What counts is what is sent: the controller will check the same segments again, and a long
    # run of close knots is sampled anew.
    require_within(from_wire(to_wire(whole).messages), limits)
    return whole


def closed(knots: Knots, present_preload: Array) -> Knots:
    """The knots with the closing of the grip in front: at rest, the preload grows slowly."""
    if knots.preload is None:
        return knots
    change = float(np.abs(knots.preload[0] - present_preload).max())
    seconds = max(change / CLOSING_RAD_S, _SHORTEST_CLOSING_S)
    return Knots(
        np.concatenate([[0.0], knots.time_s + seconds]),
        *(np.vstack([c[:1], c]) for c in (knots.position, knots.velocity, knots.acceleration)),
        preload=np.vstack([present_preload, knots.preload]),
    )


def start_of(knots: Knots, present_preload: Array) -> Knots:
    """Only the first posture, with the preload that there is: where to wait for the tool."""
    still = np.zeros((1, knots.position.shape[1]))
    return Knots(np.zeros(1), knots.position[:1], still, still, present_preload[None])


def from_present(present: Sample, knots: Knots, limits: JointLimits, far: bool) -> Knots:
    """The knots with the way from where the hand is; refused where it is long and not asked for."""
    distance = np.abs(present.command_rad - knots.position[0])
    worst = int(distance.argmax())
    if distance[worst] > START_DISTANCE_RAD and not far:
        raise StartTooFar(
            f"{limits.names[worst]} is {np.degrees(distance[worst]):.1f} degrees from where the "
            "trajectory starts (2 are allowed); bring the hand there, or ask for a move to start"
        )
    return approach(resting_within(present, limits), knots, limits, APPROACH_SHARE)


def resting_within(present: Sample, limits: JointLimits) -> Array:
    """Where the path may begin: what the encoders say, or the limit that it lies just beyond."""
    nearest = np.minimum(np.maximum(present.command_rad, limits.lower_rad), limits.upper_rad)
    beyond = np.abs(present.command_rad - nearest)
    worst = int(beyond.argmax())
    if beyond[worst] > OUTSIDE_RAD:
        raise StartTooFar(
            f"{limits.names[worst]} rests {np.degrees(beyond[worst]):.1f} degrees beyond its limit; "
            "bring it back by hand"
        )
    return nearest


def _require_preload(knots: Knots, limits: JointLimits) -> None:
    if knots.preload is None:
        return
    largest = np.abs(knots.preload).max(axis=0)
    worst = int(largest.argmax())
    if largest[worst] > PRELOAD_LIMIT_RAD:
        raise LimitsError(
            f"{limits.names[worst]}: the grip's goal lies {largest[worst]:.3g} rad beyond the joint; "
            f"allowed is {PRELOAD_LIMIT_RAD:g} rad"
        )
    speed = np.abs(np.diff(knots.preload, axis=0) / np.diff(knots.time_s)[:, None])
    segment, fastest = np.unravel_index(speed.argmax(), speed.shape)
    if speed[segment, fastest] > PRELOAD_SPEED_RAD_S:
        raise LimitsError(
            f"{limits.names[fastest]}: the grip's goal moves at {speed[segment, fastest]:.3g} rad/s "
            f"against the joint at {knots.time_s[segment]:.3f} s; allowed is "
            f"{PRELOAD_SPEED_RAD_S:g} rad/s"
        )
