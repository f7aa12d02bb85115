"""Paths of the first hand: every state is a good one, and every end has its reason."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fpcad.model.equilibrium import greatest_load, least_torque
from fpcad.wield.integrate import Step, advance
from fpcad.wield.load import Load
from fpcad.wield.rates import End, Mechanism
from fpcad.wield.trace import PathState, Stepping, trace
from tests.model.plain_hand import Array, Posture
from tests.wield.wielding import Wielding

POSES = ("carve", "poke", "press")
DIRECTIONS = (-1.0, 1.0)


def held(m: Mechanism, load: Load, turn: float, x: Array, direction: float) -> bool:
    """Whether the tool is in equilibrium with the tip force against the direction of turning."""
    wrench, torque, tip = (v.copy() for v in m.kernels.statics(m.design, m.hand, turn, x))
    pull = direction * load.tip_force_n * tip
    cap, facets = load.max_joint_torque_nmm, load.cone_facets
    return least_torque(wrench, torque, pull, cap, facets) is not None


def posture(bench, wielding: Wielding, state: PathState) -> Posture:
    m = wielding.mechanism
    fingers = tuple(contact.finger for contact in bench.spec.poses[wielding.path.pose].contacts)
    return Posture(
        fingers, m.design, state.turn, m.hand, state.x[:12].reshape(4, 3), state.x[12:].reshape(-1, 4)
    )  # fmt: skip


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize("pose", POSES)
class TestEveryState:
    def test_touches_within_a_nanometre(self, bench, wielding, pose: str, direction: float):
        for state in wielding[pose].traces[direction].states:
            at = posture(bench, wielding[pose], state)
            for i in range(len(at.fingers)):
                tool, finger = at.tool(i), at.finger(i)
                assert np.linalg.norm(tool.p - finger.p) <= 1e-6
                assert np.linalg.norm(tool.normal + finger.normal) <= 1e-8

    def test_is_inside_its_bounds_and_clear_of_collisions(
        self, wielding, pose: str, direction: float
    ):
        m = wielding[pose].mechanism
        for state in wielding[pose].traces[direction].states:
            assert (state.x - m.bounds[0]).min() >= -1e-6
            assert (m.bounds[1] - state.x).min() >= -1e-6
            residual = m.kernels.residual(m.design, state.turn, wielding[pose].y(state.x))
            assert min(part.min() for part in residual[1:]) >= -1e-6

    def test_is_held(self, wielding, pose: str, direction: float):
        """By the torque that it tells, which stays below the cap."""
        m, load = wielding[pose].mechanism, wielding[pose].load
        for state in wielding[pose].traces[direction].states:
            assert 0 < state.torque_nmm <= load.max_joint_torque_nmm
            tighter = replace(load, max_joint_torque_nmm=state.torque_nmm * (1 + 1e-4))
            assert held(m, tighter, state.turn, state.x, direction)
            weaker = replace(load, max_joint_torque_nmm=state.torque_nmm * (1 - 1e-4))
            assert not held(m, weaker, state.turn, state.x, direction)

    def test_tells_the_tip_force_that_saturates_a_motor(
        self, wielding, pose: str, direction: float
    ):
        """At that force the least largest motor torque is what a motor gives; 1 N scales with it."""
        m, load = wielding[pose].mechanism, wielding[pose].load
        for state in wielding[pose].traces[direction].states[::5]:
            wrench, torque, tip = (
                v.copy() for v in m.kernels.statics(m.design, m.hand, state.turn, state.x)
            )
            motors = load.motor_per_joint_torque @ torque
            pull = direction * tip
            at_force = least_torque(wrench, motors, state.tip_force_n * pull, 1e6, load.cone_facets)
            assert at_force is not None
            assert at_force.largest_torque_nmm == pytest.approx(
                load.motor_torque_nmm.min(), rel=1e-6
            )
            limit = 2 * load.motor_torque_nmm
            twice = greatest_load(wrench, motors, pull, limit, load.cone_facets)
            assert twice == pytest.approx(2 * state.tip_force_n, rel=1e-6)


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize("pose", POSES)
class TestEveryPath:
    def test_begins_with_the_pose(self, wielding, pose: str, direction: float):
        first = wielding[pose].traces[direction].states[0]
        assert first.turn == 0 and first.sliding_mm == 0
        assert np.array_equal(first.x, wielding[pose].pose[6:])

    def test_takes_full_steps_and_then_a_shorter_one(self, wielding, pose: str, direction: float):
        turns = [state.turn for state in wielding[pose].traces[direction].states]
        steps = direction * np.diff(turns)
        assert np.allclose(steps[:-1], wielding[pose].stepping.step)
        assert 0 < steps[-1] <= wielding[pose].stepping.step * (1 + 1e-9)

    def test_ends_where_the_next_step_fails_for_the_reason_given(
        self, wielding, pose: str, direction: float
    ):
        """The last step was bisected: the shortest step known to fail is one halving longer."""
        at, found = wielding[pose], wielding[pose].traces[direction]
        assert found.end is not End.COMPLETE
        base, last = found.states[-2:]
        reached = direction * (last.turn - base.turn)
        if np.isclose(reached, at.stepping.step):
            base, reached = last, 0.0
        halvings = np.ceil(np.log2(at.stepping.step / at.stepping.end_tolerance))
        failing = reached + at.stepping.step / 2**halvings
        assert failing - reached <= at.stepping.end_tolerance
        beyond = advance(at.mechanism, base.turn, base.x, direction, failing)
        if isinstance(beyond, End):
            assert beyond is found.end
        else:
            turn = base.turn + direction * failing
            assert not held(at.mechanism, at.load, turn, beyond.x, direction)
            assert found.end is End.STATICS

    def test_is_the_same_when_traced_again(self, wielding, pose: str, direction: float):
        at = wielding[pose]
        again = trace(at.mechanism, at.load, at.pose[6:], direction, at.stepping)
        assert again.end is at.traces[direction].end
        for ours, theirs in zip(again.states, at.traces[direction].states, strict=True):
            assert ours.turn == theirs.turn and np.array_equal(ours.x, theirs.x)


@pytest.mark.parametrize("pose", POSES)
def test_the_range_hardly_depends_on_the_step(wielding, pose: str):
    """Within 3 % between steps of 0.02 and 0.005 rad."""
    at, ranges = wielding[pose], []
    for step in (0.02, 0.005):
        stepping = Stepping(step, 5e-4, np.pi)
        ends = [trace(at.mechanism, at.load, at.pose[6:], way, stepping) for way in DIRECTIONS]
        ranges.append(sum(abs(end.states[-1].turn) for end in ends))
    assert ranges[0] == pytest.approx(ranges[1], rel=0.03)


@pytest.mark.parametrize("direction", DIRECTIONS)
def test_a_path_is_complete_at_the_longest_turn(wielding, direction: float):
    at = wielding["press"]
    short = trace(at.mechanism, at.load, at.pose[6:], direction, Stepping(0.02, 1e-3, 0.05))
    assert short.end is End.COMPLETE
    assert [state.turn for state in short.states] == pytest.approx(
        [0, 0.02 * direction, 0.04 * direction, 0.05 * direction]
    )


def test_a_pose_that_is_not_held_has_no_path(wielding):
    at = wielding["carve"]
    weak = replace(at.load, max_joint_torque_nmm=1.0)
    none = trace(at.mechanism, weak, at.pose[6:], 1.0, at.stepping)
    assert none.end is End.STATICS and len(none.states) == 1
    assert none.states[0].torque_nmm == np.inf and none.states[0].tip_force_n == 0


def test_a_lower_cap_ends_a_path_sooner_for_statics(wielding):
    at = wielding["press"]
    whole = at.traces[1.0]
    limit = float(np.median([state.torque_nmm for state in whole.states]))
    capped = trace(
        at.mechanism, replace(at.load, max_joint_torque_nmm=limit), at.pose[6:], 1.0, at.stepping
    )
    assert capped.end is End.STATICS
    assert capped.states[-1].turn < whole.states[-1].turn
    assert max(state.torque_nmm for state in capped.states) <= limit


def test_motion_that_cannot_go_on_ends_for_limits(wielding):
    at = wielding["press"]
    frozen = replace(at.mechanism, max_joint_rate=1e-3, graph=None)
    stuck = trace(frozen, at.load, at.pose[6:], 1.0, at.stepping)
    assert stuck.end is End.RATES and len(stuck.states) == 1


def test_the_reason_is_what_fails_just_beyond_the_end(wielding, monkeypatch: pytest.MonkeyPatch):
    """A full step fails for another reason than one that is a little too long."""
    at = wielding["press"]

    def stubborn(
        m: Mechanism, load: Load, turn: float, x: Array, direction: float, dt: float
    ) -> Step | End:
        if turn + dt > 0.016:
            return End.RATES
        return End.SINGULAR if turn + dt > 0.013 else Step(x, np.zeros(4))

    monkeypatch.setattr("fpcad.wield.trace.step", stubborn)
    weightless = replace(at.load, tip_force_n=0.0)
    found = trace(at.mechanism, weightless, at.pose[6:], 1.0, Stepping(0.02, 1e-4, 1.0))
    assert found.end is End.SINGULAR
    assert 0.013 - 1e-4 <= found.states[-1].turn <= 0.013
