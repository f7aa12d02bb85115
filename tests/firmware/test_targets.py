"""The protocol's tests over serial lines: simulator, host build, Cortex-M3 in QEMU, AVR in simavr."""

import struct
import time
from contextlib import ExitStack, closing
from itertools import product

import numpy as np
import pytest

from fpcad.run.messages import (
    Ack,
    Arm,
    AskHoming,
    AskLimits,
    End,
    Estop,
    Health,
    Hello,
    Home,
    Knot,
    NoSession,
    Ping,
    Reason,
    Refused,
    Start,
    State,
    Telemetry,
)
from fpcad.run.port import open_port
from fpcad.run.run_trajectory import SIMULATED_PORTS, run_trajectory
from fpcad.run.sim.states import NEXT
from tests.firmware.core import made
from tests.firmware.segments import PIECE, random_segments, starts_of_pieces
from tests.firmware.targets import SETUPS, running
from tests.firmware.test_core import reference
from tests.firmware.test_preload import BEYOND, BEYOND_IDS, counts
from tests.firmware.wire import WireBench
from tests.run.fixtures import hand_limits, swing, write_trajectory
from tests.run.proxy import damaged_port
from tests.run.test_states import COMMANDS, HARMFUL, RESTING, knot
from tests.run.virtual import bit_flips

RESTING_STATES = (State.READY, State.ARMED, State.RUNNING, State.HOLD, State.ESTOP)
HOMING_STATES = (State.IDLE, State.HOMING)
"""BOOT and FAULT take a boot and a fault; the bench of test_states.py puts controllers into them."""


@pytest.fixture(scope="module", params=[*SIMULATED_PORTS, *SETUPS])
def port(request):
    """A controller for the hand of the fixtures, at rest where the swing begins."""
    with ExitStack() as stack:
        if request.param in SETUPS:
            yield stack.enter_context(running(request.param))
            return
        if request.param == "fw":
            made("host")
        start = SIMULATED_PORTS[request.param]
        changes = {"silence_us": 10**9} if request.param == "fw" else {}
        device = stack.enter_context(start(hand_limits(), swing().position[0], **changes))
        # The process ends with its last host, so there is always one.
        stack.enter_context(closing(KeptOpen(device.port)))
        yield device.port


class KeptOpen:
    """A second holder of the line that neither reads nor locks it."""

    def __init__(self, port):
        self._file = open(port, "rb", buffering=0)  # noqa: SIM115

    def close(self):
        self._file.close()


@pytest.fixture
def bench(port):
    with closing(open_port(port)) as line:
        yield WireBench(line)


@pytest.mark.real_time
def test_pairs_of_states_at_rest_or_on_a_path_have_their_answer(bench):
    for state, command in product(RESTING_STATES, COMMANDS):
        if (state, command) != (State.READY, Home):
            require_answer(bench, state, command)


def require_answer(bench, state, command):
    """That of the table, or that of a question, which every state answers."""
    bench.into(state, RESTING)
    answer = bench.ask(COMMANDS[command])
    if command in (Ping, AskLimits, AskHoming, Hello):
        assert not isinstance(answer, Refused | Ack | None), (state, command)
    elif command is Start and state is State.ARMED and isinstance(answer, Refused):
        assert answer.reason == Reason.START_TIME  # fixed, and the controller runs for long
    elif (state, command) in NEXT:
        assert isinstance(answer, Ack), (state, command, answer)
        assert answer.state == NEXT[state, command]
    else:
        assert isinstance(answer, Refused) and answer.state == state, (state, command)


def test_what_would_do_harm_is_refused(bench):
    for before, message, reason, joint in HARMFUL:
        if reason == Reason.BUFFER_FULL:
            continue  # buffers differ; the next test fills them
        bench.into(State.READY, ())
        for earlier in (Arm(), *before):
            assert isinstance(bench.ask(earlier), Ack)
        if reason == Reason.TOO_LITTLE_PREFILL:
            message = Start(bench.ask(Ping(0)).device_us + 1_000_000)
        answer = bench.ask(message)
        assert isinstance(answer, Refused), message
        assert (answer.reason, answer.joint) == (reason, joint)
        assert bench.now().state == State.ARMED


def test_a_full_buffer_refuses_knots(bench):
    bench.into(State.READY, ())
    room = bench.open().buffer_knots
    bench.ask(Arm())
    answers = [bench.ask(knot(40_000 * k)) for k in range(room + 1)]
    assert [answer.free_knots for answer in answers[:-1]] == list(range(room))[::-1]
    assert isinstance(answers[-1], Refused) and answers[-1].reason == Reason.BUFFER_FULL


@pytest.mark.parametrize(("before", "t_us", "preload", "joint"), BEYOND, ids=BEYOND_IDS)
def test_a_preload_beyond_its_bounds_is_refused(bench, before, t_us, preload, joint):
    bench.into(State.ARMED, [knot(500_000 * k, preload=counts(x)) for k, x in enumerate(before)])
    answer = bench.ask(knot(t_us, preload=preload))
    assert (answer.reason, answer.joint) == (Reason.PRELOAD_LIMIT, joint)


@pytest.mark.real_time
def test_a_grip_closes_holds_and_opens(bench):
    grip = tuple(counts([0.1, 0.0, 0.2] * 4))
    path = [knot(500_000 * k, preload=p) for k, p in enumerate((counts(0), grip, grip, counts(0)))]
    bench.into(State.RUNNING, (*path, End(len(path))))
    bench.stay_until(lambda m: isinstance(m, Health) and tells(m, grip))
    bench.stay_until(lambda m: isinstance(m, Telemetry) and m.state == State.READY)
    bench.stay_until(lambda m: isinstance(m, Health) and tells(m, counts(0)))


def tells(health, preload):
    return np.abs(np.subtract(health.preload_20urad, preload)).max() <= 1


def test_strangers_may_only_stop(bench):
    bench.into(State.ARMED, RESTING)
    assert isinstance(bench.ask(Ping(1), session=999), NoSession)
    assert isinstance(bench.ask(Estop(), session=999), Ack)
    assert bench.now().state == State.ESTOP
    bench.into(State.READY, ())


@pytest.mark.real_time
def test_bytes_of_noise_do_nothing(bench):
    bench.into(State.READY, ())
    noise = np.random.default_rng(3).integers(0, 256, 3000, np.uint8).tobytes()
    for at in range(0, len(noise), 200):  # as much at once as the host ever has on the way
        bench._line.write(noise[at : at + 200])
        time.sleep(0.02)
    bench.open()
    assert bench.now().state == State.READY
    assert bench.ask(AskLimits()) == hand_limits().on_wire()


@pytest.mark.real_time
def test_a_trajectory_is_followed(port, tmp_path, request):
    # An AVR takes 37 ms for a knot, so it gets a motion that its buffer holds at once.
    motion = swing(3.0, 41) if "[avr]" in request.node.name else swing()
    with closing(open_port(port)) as line:
        WireBench(line).into(State.READY, ())
    report = run_trajectory(write_trajectory(tmp_path, motion), hand_limits(), port)
    assert report.final_state == "READY" and report.max_error_all_rad < 0.005


@pytest.mark.real_time
def test_a_trajectory_is_followed_over_a_bad_line(port, tmp_path, request):
    motion = swing(3.0, 41) if "[avr]" in request.node.name else swing()
    with closing(open_port(port)) as line:
        WireBench(line).into(State.READY, ())
    file = write_trajectory(tmp_path, motion)
    with damaged_port(port, bit_flips(3e-4, 1), bit_flips(3e-4, 2)) as bad:
        report = run_trajectory(file, hand_limits(), bad)
    assert report.final_state == "READY" and report.resends + report.bad_frames > 0


@pytest.mark.parametrize("target", SETUPS)
def test_quintics_agree_within_a_count_on(target):
    count, seed = 10_000, 5
    with running(target, f"{target}_segments.elf") as name, closing(open_port(name)) as line:
        pieces = [ask_for_segments(line, start) for start in starts_of_pieces(count, seed)]
    results = np.concatenate(pieces)
    assert len(results) == count
    motion = reference(random_segments(count, seed))
    wanted = np.stack([motion.position, motion.velocity, motion.acceleration], axis=1) * 1e6
    assert np.abs(results - wanted).max() <= 1


def ask_for_segments(line, start, tries=3):
    """Results (PIECE, 3) of the segments that follow from a state of the generator.

    A pseudo terminal whose reader gets no turn loses bytes, so a piece that is short is asked for again.
    """
    for _ in range(tries):
        line.write(struct.pack("<II", start, PIECE))
        data, heard_s = b"", time.monotonic()
        while len(data) < 12 * PIECE and time.monotonic() - heard_s < 2.0:
            more = line.read()
            data, heard_s = data + more, time.monotonic() if more else heard_s
        if len(data) == 12 * PIECE:
            return np.frombuffer(data, "<i4").reshape(-1, 3)
    raise AssertionError(f"{len(data)} bytes of {12 * PIECE}")


def test_knots_beyond_the_joints_are_malformed(bench):
    bench.into(State.ARMED, ())
    thirteen = (0,) * 13
    assert isinstance(bench.ask(Arm()), Refused)
    bench.into(State.ARMED, ())
    answer = bench.ask(Knot(0, *[thirteen] * 4))
    assert isinstance(answer, Refused) and answer.reason == 2


@pytest.mark.real_time
def test_pairs_of_a_search_for_zeros_have_their_answer(bench):
    """The last one at each port, for the joints have moved afterwards."""
    for state, command in [*product(HOMING_STATES, COMMANDS), (State.READY, Home)]:
        require_answer(bench, state, command)
    bench.into(State.READY, ())
