"""Tracing a path in one direction until something ends it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.model.equilibrium import greatest_load, least_torque
from fpcad.wield.integrate import Step, step
from fpcad.wield.load import Load
from fpcad.wield.rates import End, Mechanism

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Stepping:
    """Lengths [rad] of steps, of the sharpness of the end, and of a complete path."""

    step: float
    end_tolerance: float
    max_turn: float


@dataclass(frozen=True)
class PathState:
    """One state of a path."""

    turn: float  # tool angle [rad]
    x: Array  # (n_u + 4n,) state [u, a]
    torque_nmm: float  # least largest joint torque against the tip force
    tip_force_n: float  # largest tip force that the motors hold
    sliding_mm: float  # sum over the contacts of the sliding on the way to this state


@dataclass(frozen=True)
class Trace:
    """States of one direction, the pose first, and why they end."""

    states: list[PathState]
    end: End


def trace(m: Mechanism, load: Load, x: Array, direction: float, stepping: Stepping) -> Trace:
    """Turn the tool from the pose's state x until the path ends.

    The last step is bisected until its length is known to `stepping.end_tolerance`. A pose that is
    not even held itself has that one state, with infinite torque.
    """
    start = _hold(m, load, 0.0, Step(x, np.zeros(1)), direction)
    if start is None:
        return Trace([PathState(0.0, x, np.inf, 0.0, 0.0)], End.STATICS)
    states, end = [start], End.COMPLETE
    while (left := stepping.max_turn - abs(states[-1].turn)) > 1e-9:
        length = min(stepping.step, left)
        reached = _next(m, load, states[-1], direction, length)
        if isinstance(reached, End):
            end, last = _bisect(
                m, load, states[-1], direction, length, stepping.end_tolerance, reached
            )
            states += [last] if last is not None else []
            break
        states.append(reached)
    return Trace(states, end)


def _next(
    m: Mechanism, load: Load, state: PathState, direction: float, length: float
) -> PathState | End:
    reached = step(m, load, state.turn, state.x, direction, length)
    if isinstance(reached, End):
        return reached
    held = _hold(m, load, state.turn + direction * length, reached, direction)
    return End.STATICS if held is None else held


def _bisect(
    m: Mechanism,
    load: Load,
    state: PathState,
    direction: float,
    failing: float,
    tolerance: float,
    reason: End,
) -> tuple[End, PathState | None]:
    """The longest last step that succeeds, and the reason why a longer one does not."""
    reachable, last = 0.0, None
    while failing - reachable > tolerance:
        middle = (reachable + failing) / 2
        reached = _next(m, load, state, direction, middle)
        if isinstance(reached, End):
            failing, reason = middle, reached
        else:
            reachable, last = middle, reached
    return reason, last


def _hold(m: Mechanism, load: Load, turn: float, step: Step, direction: float) -> PathState | None:
    """The state reached by a step, if the tool can be held in it against the tip force."""
    if step.holding is not None:
        return PathState(turn, step.x, *step.holding, float(step.sliding.sum()))
    wrench, torque, tip = (v.copy() for v in m.kernels.statics(m.design, m.hand, turn, step.x))
    pull = direction * tip
    cap, facets = load.max_joint_torque_nmm, load.cone_facets
    holding = least_torque(wrench, torque, load.tip_force_n * pull, cap, facets)
    if holding is None:
        return None
    motor_torque = load.motor_per_joint_torque @ torque
    force = greatest_load(wrench, motor_torque, pull, load.motor_torque_nmm, facets)
    return PathState(turn, step.x, holding.largest_torque_nmm, force, float(step.sliding.sum()))
