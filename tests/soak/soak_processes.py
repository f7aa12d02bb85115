"""Long tests with real processes, real time and a busy machine: `make soak`.

A test that fails while the machine itself was late is tried again, three times at most.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from fpcad.run.codec import KINDS, encode
from fpcad.run.errors import ControllerHeld
from fpcad.run.framing import Frame, FrameReader, encode_frame
from fpcad.run.limits import read_limits
from fpcad.run.messages import Ack, Estop, Ping, State
from fpcad.run.port import open_port
from fpcad.run.report import RunReport
from fpcad.run.run_trajectory import SIMULATED_PORTS, run_trajectory
from tests.firmware.core import made
from tests.firmware.lateness import Lateness, judged_fairly
from tests.firmware.targets import SETUPS, running
from tests.firmware.wire import WireBench
from tests.run.fixtures import hand_limits, swing, write_trajectory
from tests.run.proxy import damaged_port
from tests.run.test_process import is_gone, read_record, wait_until
from tests.run.virtual import bit_flips

pytestmark = pytest.mark.real_time
SEED = 20
ACCELERATION = hand_limits().acceleration_rad_s2[0]
TICK_HZ = 250


def fresh(folder: Path) -> Path:
    """A new folder in there, for each try."""
    return Path(tempfile.mkdtemp(dir=folder))


def host(folder: Path, port: str = "fw") -> tuple[subprocess.Popen, int]:
    """A host that streams six seconds, and the controller's process."""
    made("host")
    process = subprocess.Popen(
        [sys.executable, "-m", "tests.run.killed_host", str(folder), port],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
    )
    assert process.stdout is not None
    return process, int(process.stdout.readline())


def wait_for_path(process: subprocess.Popen, path_s: float) -> None:
    assert process.stdout is not None
    while line := process.stdout.readline():
        if float(line) >= path_s:
            return
    assert process.stderr is not None
    raise AssertionError(process.stderr.read().splitlines()[-1])


@contextmanager
def busy(count: int = 4):
    """Processes that keep the machine busy."""
    with ExitStack() as stack:
        for _ in range(count):
            spin = subprocess.Popen([sys.executable, "-c", "while True: pass"])
            stack.callback(spin.wait)
            stack.callback(spin.kill)
        yield


def stopping(folder: Path) -> tuple[float, float, State]:
    """Seconds from the last running tick to rest, largest acceleration of commands, last state."""
    rows = read_record(folder / "record")
    time_s, state, rate, command = rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 3:15]
    running = time_s[state == State.RUNNING]
    resting = time_s[(time_s > running[-1]) & (rate == 0)]
    acceleration = np.abs(np.diff(command, 2, axis=0)).max() * TICK_HZ**2
    return float(resting[0] - running[-1]), float(acceleration), State(int(state[-1]))


PHASES = 50
AT_ONCE = 4
"""Hosts side by side; each is idle nearly all the time."""


@dataclass(frozen=True)
class Struck:
    """How a hand fared whose host was struck."""

    phase_s: float
    outlived_s: float
    slowing_s: float
    acceleration: float
    state: str


def strike(blow: signal.Signals, phase_s: float, folder: Path) -> Struck:
    folder.mkdir()
    process, device = host(folder)
    wait_for_path(process, phase_s)
    process.send_signal(blow)
    struck = time.monotonic()
    if blow == signal.SIGSTOP:
        time.sleep(1.0)
        process.kill()
    process.wait()
    wait_until(lambda: is_gone(device))
    outlived = time.monotonic() - struck
    seconds, acceleration, state = stopping(folder)
    return Struck(phase_s, outlived, seconds, acceleration, state.name)


@pytest.mark.parametrize("blow", [signal.SIGKILL, signal.SIGSTOP])
def test_a_host_that_dies_or_freezes_at_any_phase(blow, tmp_path):
    phases = np.random.default_rng(SEED).uniform(0.05, 5.0, PHASES)
    folder = fresh(tmp_path)
    with Lateness() as machine, ThreadPoolExecutor(AT_ONCE) as pool:
        jobs = [pool.submit(strike, blow, p, folder / f"{i}") for i, p in enumerate(phases)]
        hands = [job.result() for job in jobs]
    slowest, hardest = max(h.slowing_s for h in hands), max(h.acceleration for h in hands)
    outlived = [h.outlived_s for h in hands]
    print(
        f"\n{blow.name} at {PHASES} phases, seed {SEED}: {dict(Counter(h.state for h in hands))}; the "
        f"firmware outlived it for {np.median(outlived):.3f} s (median), {max(outlived):.3f} s (most); "
        f"slowing down took at most {slowest:.3f} s, acceleration at most {hardest:.2f} of "
        f"{ACCELERATION:.2f} rad/s^2; {machine}"
    )
    assert {h.state for h in hands} == {"HOLD"} and hardest <= ACCELERATION * 1.05
    # The firmware ends once its joints stand; its longest life also tells how late the machine was.
    alive_s = (0.6 if blow == signal.SIGKILL else 1.1) + slowest
    assert np.median(outlived) < alive_s + machine.worst_s


CLAY = sorted((Path(__file__).parents[2] / "build/clay/trajectories").glob("*.json"))


@pytest.mark.skipif(not CLAY, reason="needs `make design NAME=clay` first")
@pytest.mark.parametrize("file", CLAY, ids=lambda file: file.stem)
def test_trajectories_of_a_build_stream_on_a_busy_machine(file):
    """At their own spacing: some 30 knots a second and more, with four busy processes beside."""
    made("host")
    hand = file.parents[1] / "hand"
    urdf = next((hand / "urdf").glob("*.urdf"))
    limits = read_limits(urdf, np.radians(720.0), hand / "transmission.yaml")
    with busy(), Lateness() as machine:
        report = run_trajectory(file, limits, "fw", loops=3, speed=0.95)
    print(
        f"\n{file.stem}, three times, 4 busy processes: {report.knots} knots in {report.seconds:.1f} s "
        f"({report.knots / report.seconds:.1f} a second), 0 underruns, {report.resends} resends, largest "
        f"error {report.max_error_all_rad:.4f} rad; {machine}"
    )
    assert report.final_state == "READY" and report.knots / report.seconds >= 25


@pytest.mark.parametrize("stall_s", [0.05, 0.2, 0.45])
def test_a_host_that_stalls_on_a_busy_machine(stall_s, tmp_path):
    lasted = []
    with busy():
        for _ in range(3):
            folder = fresh(tmp_path)
            process, _ = host(folder)
            for phase in (1.0, 2.5, 4.0):
                wait_for_path(process, phase)
                began = time.perf_counter()
                process.send_signal(signal.SIGSTOP)
                time.sleep(stall_s)
                process.send_signal(signal.SIGCONT)
                lasted.append(time.perf_counter() - began)
                print(f"{lasted[-1]:.3f}", end=" ")
            _, complaint = process.communicate(timeout=20)
            rows = read_record(folder / "record")
            assert process.returncode == 0, complaint
            assert State(int(rows[-1, 1])) is State.READY
    print(
        f"\n9 stalls of {stall_s * 1e3:.0f} ms (up to {max(lasted) * 1e3:.0f} as the machine was "
        "busy), 4 busy processes: 0 underruns"
    )


@pytest.mark.parametrize("stall_s", [0.7, 2.0])
def test_a_longer_stall_holds_and_is_not_resumed(stall_s, tmp_path):
    folder = fresh(tmp_path)
    process, device = host(folder)
    wait_for_path(process, 1.0)
    process.send_signal(signal.SIGSTOP)
    time.sleep(stall_s)
    process.send_signal(signal.SIGCONT)
    _, complaint = process.communicate(timeout=20)
    wait_until(lambda: is_gone(device))
    assert process.returncode != 0 and ControllerHeld.__name__ in complaint
    assert State(int(read_record(folder / "record")[-1, 1])) is State.HOLD


def over_a_bad_line(name: str, file: Path, seed: int) -> RunReport:
    damage = bit_flips(3e-4, seed), bit_flips(3e-4, seed + 9)
    with damaged_port(name, *damage) as port:
        return run_trajectory(file, hand_limits(), port, clear=True)


@pytest.mark.parametrize("target", SETUPS)
def test_microcontrollers_follow_over_a_bad_line(target, tmp_path):
    file, resends, bad = write_trajectory(tmp_path, swing(3.0, 46)), 0, 0
    with running(target) as name:
        for seed in range(5):
            report = judged_fairly(lambda seed=seed: over_a_bad_line(name, file, seed), target)
            resends, bad = resends + report.resends, bad + report.bad_frames
            assert report.final_state == "READY"
    print(f"\n{target}: 5 runs at 3e-4 flips a byte, {resends} resends, {bad} bad frames")


@pytest.mark.parametrize("target", [*SIMULATED_PORTS, *SETUPS])
def test_how_fast_a_target_answers(target):
    with ExitStack() as stack:
        if target in SETUPS:
            name = stack.enter_context(running(target))
        else:
            made("host")
            device = SIMULATED_PORTS[target](hand_limits(), swing().position[0])
            name = stack.enter_context(device).port
        bench = WireBench(stack.enter_context(closing(open_port(name))))
        bench.into(State.READY, ())
        trips = sorted(timed(bench, Ping(0)) for _ in range(300))
        stops = []
        for _ in range(30):
            bench.into(State.READY, ())
            stops.append(timed(bench, Estop()))
        stops.sort()
        rate = pings_per_second(bench)
    print(
        f"\n{target}: round trip p50 {trips[150] * 1e3:.2f} ms, p99 {trips[297] * 1e3:.2f} ms; "
        f"e-stop until confirmed p50 {stops[15] * 1e3:.2f} ms, worst {stops[-1] * 1e3:.2f} ms; "
        f"{rate:.0f} frames/s"
    )
    assert trips[297] < 0.25


def timed(bench: WireBench, message) -> float:
    started = time.perf_counter()
    answer = bench.ask(message)
    assert answer is not None and (isinstance(answer, Ack) or isinstance(message, Ping))
    return time.perf_counter() - started


def pings_per_second(bench: WireBench, seconds: float = 2.0) -> float:
    """Pings answered a second with eight on the way."""
    line, reader, answered, sent = bench._line, FrameReader(), 0, 0
    ping = encode_frame(Frame(KINDS[Ping].code, 0, bench.session, encode(Ping(1))))
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        while sent - answered < 8:
            line.write(ping)
            sent += 1
        answered += sum(frame.kind == 0x42 for frame in reader.feed(line.read()))
    return answered / seconds
