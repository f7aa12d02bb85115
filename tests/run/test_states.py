"""The controller's table of states, pair by pair, over the wire."""

from itertools import product

import numpy as np
import pytest

from fpcad.run.codec import KINDS, decode, encode
from fpcad.run.framing import Frame, FrameReader, encode_frame
from fpcad.run.knots import to_wire
from fpcad.run.messages import (
    Ack,
    Arm,
    AskHoming,
    AskLimits,
    Calibrate,
    Clear,
    End,
    Estop,
    Hello,
    Hold,
    Home,
    Knot,
    NoSession,
    Ping,
    Pong,
    Reason,
    Refused,
    Start,
    State,
    Welcome,
)
from fpcad.run.sim.states import NEXT
from tests.run.fixtures import hand_limits, swing
from tests.run.virtual import controller

pytestmark = pytest.mark.usefixtures("each_controller")

SESSION = 21
KNOTS = to_wire(swing()).messages


def knot(t_us, position=None, velocity=0, acceleration=0, preload=(0,) * 12):
    at = position if position is not None else KNOTS[0].position_urad
    return Knot(t_us, tuple(at), (velocity,) * 12, (acceleration,) * 12, tuple(preload))


COMMANDS = {
    Arm: Arm(),
    Knot: knot(2_000_000),
    Start: Start(10_000_000),
    End: End(2),
    Clear: Clear(),
    Home: Home(),
    Calibrate: Calibrate((0,) * 12),
    Hold: Hold(),
    Estop: Estop(),
    Ping: Ping(5),
    AskLimits: AskLimits(),
    AskHoming: AskHoming(),
    Hello: Hello(),
}

RESTING = (knot(0), knot(1_000_000))


class Bench:
    """A controller to which single messages are put."""

    def __init__(self, **changes):
        self.device = controller(**{"buffer_knots": 32, **changes})
        self.seq = 0
        self.ask(Hello())

    def ask(self, message, session=SESSION):
        """The controller's only answer."""
        kind = KINDS[type(message)]
        self.device.take_output()
        self.device.receive(encode_frame(Frame(kind.code, self.seq, session, encode(message))))
        self.seq += kind.sequenced
        (frame,) = FrameReader().feed(self.device.take_output())
        return decode(frame.kind, frame.payload)

    def into(self, state, knots=RESTING):
        """Bring a controller that is READY into a state by commands, or put it there."""
        if state in (State.ARMED, State.RUNNING):
            self.ask(Arm())
            for each in knots:
                assert isinstance(self.ask(each), Ack)
        if state is State.RUNNING:
            assert isinstance(self.ask(Start(self.device.time_us)), Ack)
            self.device.tick()
        self.device.state = state
        return self


@pytest.mark.parametrize(("state", "command"), list(product(State, COMMANDS)))
def test_each_pair_has_its_answer(state, command):
    bench = Bench().into(state)
    answer = bench.ask(COMMANDS[command])
    if command in (Ping, AskLimits, AskHoming, Hello):
        assert not isinstance(answer, Refused | Ack) and bench.device.state is state
    elif (state, command) in NEXT:
        assert isinstance(answer, Ack)
        assert bench.device.state is NEXT[state, command]
    else:
        assert isinstance(answer, Refused) and answer.reason == Reason.WRONG_STATE
        assert answer.state == state and bench.device.state is state


def test_stops_are_answered_in_every_state():
    assert all((state, stop) in NEXT for state in State for stop in (Hold, Estop))


def shifted(joint, urad):
    position = list(KNOTS[0].position_urad)
    position[joint] += urad
    return position


HARMFUL = [
    ([], knot(1), Reason.TIME_NOT_INCREASING, 0),
    ([], knot(0, velocity=1), Reason.NOT_AT_REST, 0),
    ([], knot(0, acceleration=-1), Reason.NOT_AT_REST, 0),
    ([], knot(0, shifted(4, 52_000)), Reason.TOO_FAR_FROM_START, 4),
    ([], Knot(0, *[(0,) * 11] * 4), Reason.MALFORMED, 0),
    ([knot(0)], knot(0), Reason.TIME_NOT_INCREASING, 0),
    ([knot(0), knot(40_000)], knot(39_999), Reason.TIME_NOT_INCREASING, 0),
    ([knot(0)], knot(40_000, shifted(7, 60_000)), Reason.VELOCITY_LIMIT, 7),
    ([knot(0)], knot(40_000, shifted(7, 10_000)), Reason.ACCELERATION_LIMIT, 7),
    ([knot(0)], knot(10_000_000, shifted(2, -700_000)), Reason.POSITION_LIMIT, 2),
    (
        [knot(0)] + [knot(40_000 * k) for k in range(1, 32)],
        knot(2_000_000),
        Reason.BUFFER_FULL,
        0,
    ),
    ([knot(0)], knot(2_999), Reason.SEGMENT_TIME, 0),
    ([knot(0)], knot(10_000_001), Reason.SEGMENT_TIME, 0),
    ([knot(0)], Start(1_000_000), Reason.TOO_LITTLE_PREFILL, 0),
    ([knot(0), knot(600_000)], Start(0), Reason.START_TIME, 0),
    ([knot(0), knot(600_000)], Start(2**63), Reason.START_TIME, 0),
    ([knot(0), knot(600_000)], End(3), Reason.KNOT_COUNT, 0),
    ([knot(0)], End(1), Reason.KNOT_COUNT, 0),
    ([knot(0), knot(600_000, velocity=1000)], End(2), Reason.NOT_AT_REST, 0),
    ([knot(0), knot(600_000), End(2)], knot(700_000), Reason.KNOT_COUNT, 0),
]
"""What is sent to an armed controller first, what is refused then, why and for which joint."""


@pytest.mark.parametrize(("before", "message", "reason", "joint"), HARMFUL)
def test_what_would_do_harm_is_refused_and_changes_nothing(before, message, reason, joint):
    bench = Bench()
    bench.device.tick()
    bench.ask(Arm())
    for earlier in before:
        assert isinstance(bench.ask(earlier), Ack)
    queued, state = bench.device.follower.queued, bench.device.state
    answer = bench.ask(message)
    assert isinstance(answer, Refused)
    assert (answer.reason, answer.joint) == (reason, joint)
    assert (bench.device.follower.queued, bench.device.state) == (queued, state)


def test_nothing_behind_a_refused_frame_is_done():
    bench = Bench()
    bench.ask(Arm())
    first = bench.ask(knot(5))
    assert isinstance(first, Refused)
    assert bench.ask(knot(0)) == first
    assert bench.device.follower.queued == 0


def test_repeats_are_acknowledged_but_done_once():
    bench = Bench()
    bench.ask(Arm())
    bench.ask(KNOTS[0])
    bench.seq -= 1
    assert isinstance(bench.ask(KNOTS[0]), Ack)
    assert bench.device.follower.queued == 1


def test_a_gap_is_reported_once():
    bench = Bench()
    bench.seq = 1
    assert bench.ask(Arm()).expected == 0
    bench.device.receive(encode_frame(Frame(KINDS[Arm].code, 2, SESSION, b"")))
    assert bench.device.take_output() == b""


def test_a_stranger_is_told_that_it_has_no_session():
    bench = Bench()
    assert bench.ask(Ping(1), session=SESSION + 1) == NoSession(7)
    assert isinstance(bench.ask(Ping(1)), Pong)


def test_a_stranger_cannot_take_over_a_run_but_can_stop_it():
    bench = Bench().into(State.RUNNING)
    assert isinstance(bench.ask(Hello(), session=SESSION + 1), Welcome)
    assert bench.ask(Arm(), session=SESSION + 1) == NoSession(7)
    assert isinstance(bench.ask(Estop(), session=SESSION + 1), Ack)
    assert bench.device.state is State.ESTOP


def test_torque_is_off_after_an_emergency_stop_and_returns_at_the_present_posture():
    bench = Bench().into(State.RUNNING, KNOTS[:32])
    for _ in range(100):
        bench.device.tick()
    bench.ask(Estop())
    assert not bench.device.plant.torque_on
    for _ in range(50):
        bench.device.tick()
    bench.ask(Clear())
    assert bench.device.plant.torque_on and bench.device.state is State.READY
    np.testing.assert_array_equal(bench.device.follower.command, bench.device.measured)


def test_a_controller_that_is_not_homed_does_not_arm():
    bench = Bench(homed=False)
    assert bench.ask(Arm()).state == State.IDLE


def test_clearing_an_emergency_stop_homes_nothing():
    bench = Bench(homed=False)
    bench.ask(Estop())
    bench.ask(Clear())
    assert bench.device.state is State.IDLE


def test_the_controller_survives_noise():
    rng = np.random.default_rng(5)
    bench = Bench()
    for _ in range(300):
        bench.device.receive(rng.integers(0, 256, 200, dtype=np.uint8).tobytes())
        bench.device.tick()
    bench.device.receive(b"\0")
    assert isinstance(bench.ask(Ping(3)), Pong)
    assert bench.device.state is State.READY
    np.testing.assert_array_equal(bench.device.plant.position, swing().position[0])
    assert bench.ask(AskLimits()) == hand_limits().on_wire()
