"""A step as one graph is the step of the plain functions, which decide where it fails."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fpcad.model.equilibrium import greatest_load, least_torque
from fpcad.wield.graph import GraphStep
from fpcad.wield.integrate import Step, advance, step
from fpcad.wield.rates import End
from fpcad.wield.trace import trace
from tests.wield.wielding import Wielding

POSES = ("carve", "poke", "press")
DIRECTIONS = (-1.0, 1.0)
DT = np.radians(1)


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize("pose", POSES)
def test_steps_along_a_path_are_the_plain_ones(
    wielding: dict[str, Wielding], pose: str, direction: float
):
    m = wielding[pose].mechanism
    for state in wielding[pose].traces[direction].states[:-2]:
        quick = step(m, wielding[pose].load, state.turn, state.x, direction, DT)
        plain = advance(m, state.turn, state.x, direction, DT)
        assert isinstance(quick, Step) and isinstance(plain, Step)
        assert np.abs((quick.x - plain.x) / m.kernels.layout.scale[6:]).max() < 1e-6
        assert np.allclose(quick.sliding, plain.sliding, atol=1e-7)


@pytest.mark.parametrize("pose", POSES)
def test_the_graph_alone_does_most_steps(wielding: dict[str, Wielding], pose: str):
    m, load = wielding[pose].mechanism, wielding[pose].load
    assert m.graph is not None
    done = 0
    states = wielding[pose].traces[1.0].states[:-2]
    for state in states:
        out = GraphStep(*m.graph(m.design, m.hand, state.turn, state.x, 1.0, DT, *load.values))
        done += not m.graph.failed and out.unmet[0] < 1e-8 and out.violation[0] < 1e-6
    assert done > 0.8 * len(states)


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize("pose", POSES)
def test_a_path_is_the_same_without_the_graph(
    wielding: dict[str, Wielding], pose: str, direction: float
):
    at = wielding[pose]
    plain = trace(replace(at.mechanism, graph=None), at.load, at.pose[6:], direction, at.stepping)
    quick = at.traces[direction]
    assert plain.end is quick.end
    assert plain.states[-1].turn == pytest.approx(
        quick.states[-1].turn, abs=at.stepping.end_tolerance
    )
    for ours, theirs in zip(quick.states[:-1], plain.states[:-1], strict=True):
        assert ours.torque_nmm == pytest.approx(theirs.torque_nmm, rel=1e-3)


def test_plain_functions_say_why_a_step_fails(wielding: dict[str, Wielding]):
    """Beyond the minus end of pressing no joint rates are left."""
    at = wielding["press"]
    last = at.traces[-1.0].states[-1]
    assert at.traces[-1.0].end is End.RATES
    assert advance(at.mechanism, last.turn, last.x, -1.0, DT) is End.RATES
    assert step(at.mechanism, at.load, last.turn, last.x, -1.0, DT) is End.RATES


@pytest.mark.parametrize("pose", POSES)
def test_the_graph_s_equilibrium_is_that_of_the_plain_programs(
    wielding: dict[str, Wielding], pose: str
):
    m, load = wielding[pose].mechanism, wielding[pose].load
    found = 0
    for state in wielding[pose].traces[1.0].states[:-2]:
        reached = step(m, load, state.turn, state.x, 1.0, DT)
        if not isinstance(reached, Step) or reached.holding is None:
            continue
        at = m.design, m.hand, state.turn + DT, reached.x
        wrench, torque, tip = (v.copy() for v in m.kernels.statics(*at))
        pull = load.tip_force_n * tip
        least = least_torque(wrench, torque, pull, load.max_joint_torque_nmm, load.cone_facets)
        motor_torque = load.motor_per_joint_torque @ torque
        most = greatest_load(wrench, motor_torque, tip, load.motor_torque_nmm, load.cone_facets)
        assert least is not None
        assert reached.holding.torque_nmm == pytest.approx(least.largest_torque_nmm, rel=1e-6)
        assert reached.holding.tip_force_n == pytest.approx(most, rel=1e-6)
        found += 1
    assert found > 0.8 * len(wielding[pose].traces[1.0].states)
