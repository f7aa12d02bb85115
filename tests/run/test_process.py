"""Controllers as processes behind pseudo terminals, in real time: the simulator and the firmware."""

import csv
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

from fpcad.run.errors import (
    ControllerFault,
    ControllerReset,
    ControllerSilent,
    HeldByUser,
    LinkLost,
    StartTooFar,
)
from fpcad.run.messages import State
from fpcad.run.run_trajectory import SIMULATED_PORTS, run_trajectory
from fpcad.run.sim.controller import TICK_HZ
from fpcad.run.sim.spawn import Mishap
from tests.firmware.core import made
from tests.run.fixtures import hand_limits, swing, write_trajectory
from tests.run.proxy import damaged_port
from tests.run.virtual import bit_flips, lost_bytes

START = swing().position[0]
pytestmark = pytest.mark.real_time


@pytest.fixture(params=SIMULATED_PORTS)
def port_name(request):
    if request.param == "fw":
        made("host")
    return request.param


@pytest.fixture
def controller(port_name):
    return SIMULATED_PORTS[port_name]


def wait_until(condition, patience_s=10.0):
    deadline = time.monotonic() + patience_s
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.02)


def way(port_name):
    """Knots of the way to the start: encoders see steps of 0.09 degrees, so there is one."""
    return int(port_name == "fw")


def read_record(file):
    """Rows (ticks, 27) of either program."""
    with file.open("rb") as stream:
        if stream.read(2) == b"PK":
            return np.load(file)["rows"]
    return np.fromfile(file).reshape(-1, 27)


def is_gone(pid):
    try:
        with open(f"/proc/{pid}/stat") as file:
            return file.read().rsplit(")", 1)[1].split()[0] == "Z"
    except FileNotFoundError:
        return True


def test_the_simulated_hand_follows_and_leaves_a_table(tmp_path, port_name):
    log, seen = tmp_path / "log.csv", []
    file = write_trajectory(tmp_path)
    report = run_trajectory(file, hand_limits(), port_name, log=log, on_progress=seen.append)
    assert report.final_state == "READY" and report.knots == 61 + way(port_name)
    assert report.seconds == pytest.approx(2.0 + 0.1 * way(port_name))
    assert 0 < report.rms_error_all_rad <= report.max_error_all_rad < 0.005
    assert report.wire_error_rad < 1e-6
    assert seen[-1].path_s == pytest.approx(report.seconds)
    assert seen[-1].knots_sent == report.knots
    rows = list(csv.DictReader(log.open()))
    running = [row for row in rows if row["state"] == "RUNNING"]
    errors = [
        abs(float(row["thumb_ip_flex_position_rad"]) - float(row["thumb_ip_flex_command_rad"]))
        for row in running
    ]
    assert len(running) == report.samples
    assert max(errors) == pytest.approx(report.max_error_rad[2])


def test_a_fast_clock_shortens_a_long_run(tmp_path, port_name):
    file = write_trajectory(tmp_path, swing(20.0, 501))
    report = run_trajectory(file, hand_limits(), f"{port_name}:20", loops=2)
    assert report.seconds == pytest.approx(40.0 + 0.1 * way(port_name))
    assert report.knots == 1001 + way(port_name)
    assert 0 < report.max_error_all_rad < 0.005


def test_a_far_hand_moves_to_the_start_when_asked(tmp_path, port_name, controller):
    file = write_trajectory(tmp_path)
    report = run_trajectory(file, hand_limits(), f"{port_name}:10", move_to_start=True)
    assert report.seconds > 3.0 and report.max_error_all_rad < 0.005
    with controller(hand_limits(), START - 0.1) as device, pytest.raises(StartTooFar):
        run_trajectory(file, hand_limits(), device.port)


def test_a_hand_that_rests_at_its_limits_is_seen_beyond_them_and_runs(tmp_path, port_name):
    limits = hand_limits(lower_rad=swing().position.min(axis=0))  # steps of encoders lie around it
    report = run_trajectory(write_trajectory(tmp_path), limits, f"{port_name}:5")
    assert report.final_state == "READY"


def test_a_hand_beyond_its_limits_is_not_moved(tmp_path, controller):
    limits = hand_limits(lower_rad=swing().position.min(axis=0))
    file = write_trajectory(tmp_path)
    with (
        controller(limits, limits.lower_rad - 0.01) as device,
        pytest.raises(StartTooFar, match=r"0\.6 degrees beyond its limit"),
    ):
        run_trajectory(file, limits, device.port, move_to_start=True)


@pytest.mark.parametrize("damage", [lost_bytes, bit_flips])
def test_a_bad_line_through_pseudo_terminals_is_overcome(tmp_path, damage, controller):
    file = write_trajectory(tmp_path)
    with (
        controller(hand_limits(), START) as device,
        damaged_port(device.port, damage(5e-4, 1), damage(5e-4, 2)) as port,
    ):
        report = run_trajectory(file, hand_limits(), port)
    assert report.final_state == "READY"
    assert report.resends + report.bad_frames > 0


@pytest.mark.parametrize(
    ("mishap", "error"),
    [
        (Mishap("silence", 0.8), LinkLost),
        (Mishap("garbage", 0.8), LinkLost),
        (Mishap("reset", 0.8), ControllerReset),
        (Mishap("jam", 0.5, joint=2), ControllerFault),
        (Mishap("silence", 0.0), ControllerSilent),
        (Mishap("garbage", 0.0), ControllerSilent),
    ],
    ids=lambda value: f"{value.kind} at {value.at_s}" if isinstance(value, Mishap) else None,
)
def test_mishaps_of_the_controller_have_names(tmp_path, mishap, error, controller):
    file = write_trajectory(tmp_path, swing(2.0, 61, amplitude=0.25))
    with controller(hand_limits(), START, mishaps=[mishap]) as device:
        with pytest.raises(error):
            run_trajectory(file, hand_limits(), device.port, patience_s=0.5)
        pid = device.pid
    assert is_gone(pid)


def test_a_controller_that_dies_in_mid_run_is_noticed(tmp_path, controller):
    file = write_trajectory(tmp_path)
    with controller(hand_limits(), START) as device:

        def kill(progress):
            if progress.path_s > 0.3:
                os.kill(device.pid, signal.SIGKILL)

        with pytest.raises(LinkLost, match=r"the line broke|nothing heard"):
            run_trajectory(file, hand_limits(), device.port, on_progress=kill)


def test_ctrl_c_holds(tmp_path, port_name):
    def interrupt(progress):
        if 0.5 < progress.path_s < 0.6 and progress.state == "RUNNING":
            signal.raise_signal(signal.SIGINT)
            progress_seen.append(progress)

    progress_seen = []
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(HeldByUser):
        run_trajectory(
            write_trajectory(tmp_path),
            hand_limits(),
            port_name,
            on_progress=lambda p: None if progress_seen else interrupt(p),
        )
    assert signal.getsignal(signal.SIGINT) is before


@pytest.mark.parametrize("phase_s", [0.1, 1.4])
def test_a_killed_host_leaves_joints_at_rest_and_no_process(tmp_path, phase_s, port_name):
    host = subprocess.Popen(
        [sys.executable, "-m", "tests.run.killed_host", str(tmp_path), port_name],
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
    )
    assert host.stdout is not None
    simulator = int(host.stdout.readline())
    while float(host.stdout.readline()) < phase_s:
        pass
    host.kill()
    host.wait()
    host.stdout.close()
    wait_until(lambda: is_gone(simulator))
    rows = read_record(tmp_path / "record")
    time_s, state, rate, command = rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 3:15]
    assert state[-1] == State.HOLD and rate[-1] == 0
    running = time_s[state == State.RUNNING]
    assert running[-1] - running[0] < 5.5  # of 6 s; test_silence.py holds the exact time
    assert time_s[-1] - running[-1] < 0.2  # to slow down
    acceleration = np.abs(np.diff(command, 2, axis=0)).max() * TICK_HZ**2
    assert acceleration <= hand_limits().acceleration_rad_s2[0] * 1.05


def test_an_interrupted_command_holds_and_says_so_in_one_line(tmp_path):
    """Ctrl-C to the program itself, on simulated motors that run in its own process."""
    host = subprocess.Popen(
        [sys.executable, "-m", "tests.run.interrupted_host", str(tmp_path)],
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
    )
    assert host.stdout is not None
    assert host.stdout.readline() == "moving\n"
    host.send_signal(signal.SIGINT)
    said, _ = host.communicate(timeout=20)
    assert host.returncode == HeldByUser.exit_code
    assert said.count("\n") == 1 and "the hand keeps its grip" in said
