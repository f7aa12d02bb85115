"""The sequence of a bench test: to the start, wait for the tool, close with preload, run; and its table."""

import csv
import json
import signal

import numpy as np
import pyarrow.parquet as pq
import pytest

from fpcad.run.errors import HeldByUser, LimitsError
from fpcad.run.plan import planned
from fpcad.run.run_trajectory import RunOptions, perform, run_trajectory
from tests.firmware.core import made
from tests.run.drivers.test_servo_driver import Time, simulated
from tests.run.fixtures import NAMES, hand_limits, swing, write_trajectory

GRIP = np.tile([0.02, 0.0, 0.05], 4)


def gripping(folder, preload=GRIP):
    knots = swing(1.0, amplitude=0.03)
    goals = (knots.position + preload).tolist()
    return write_trajectory(folder, knots, position_preload_rad=goals)


def grip_motion(folder):
    return planned(gripping(folder), hand_limits(), 1.0, 1)


def test_the_grip_closes_only_when_the_tool_is_in(tmp_path):
    asked, samples = [], []
    bus, driver = simulated(Time())
    bus.hand.spool_rad = bus.hand.spool_rad - 0.2  # the hand is elsewhere

    def tool_in():
        asked.append(bus.hand.joint_rad)
        return len(asked) > 30

    options = RunOptions(
        move_to_start=True, on_progress=lambda at: samples.append(at.sample), tool_in=tool_in
    )
    report = perform(driver, grip_motion(tmp_path), hand_limits(), options)
    assert report.final_state == "READY"
    start = swing().position[0]
    assert np.abs(asked[-1] - start).max() < 0.01  # open, at the start
    waited = [i for i, sample in enumerate(samples) if sample.preload_rad is None]
    assert max(np.abs(sample.preload_rad).max() for sample in samples[: waited[0]]) == 0
    after = np.array([sample.preload_rad for sample in samples[waited[-1] + 1 :]])
    assert np.abs(after[-1] - GRIP).max() < 1e-4
    assert np.abs(np.diff(after, axis=0)).max() < 0.25 * 0.011  # slowly
    assert np.abs(bus.hand.joint_rad - start - GRIP).max() < 0.01  # nothing stops simulated fingers


def test_the_first_request_to_stop_ends_the_wait(tmp_path):
    _, driver = simulated(Time())

    def tool_in():
        signal.raise_signal(signal.SIGINT)
        return False

    with pytest.raises(HeldByUser, match="the hand was open"):
        perform(driver, grip_motion(tmp_path), hand_limits(), RunOptions(tool_in=tool_in))


@pytest.mark.parametrize("port", ["sim:5", "fw:5"])
def test_controllers_close_the_grip_as_well(tmp_path, port):
    if port == "fw:5":
        made("host")
    samples, asked = [], []
    report = run_trajectory(
        gripping(tmp_path),
        hand_limits(),
        port,
        on_progress=lambda at: samples.append(at.sample),
        tool_in=lambda: len(asked) > 3 or bool(asked.append(1)),
    )
    assert report.final_state == "READY"
    assert np.abs(samples[-1].preload_rad - GRIP).max() < 0.01


def test_a_grip_beyond_its_bound_is_refused_before_anything_is_sent(tmp_path):
    with pytest.raises(LimitsError, match="the grip's goal lies"):
        run_trajectory(gripping(tmp_path, np.full(12, 0.6)), hand_limits(), "sim")


def test_a_grip_that_comes_too_fast_is_refused_before_anything_is_sent(tmp_path):
    file = gripping(tmp_path)
    document = json.loads(file.read_text())
    document["position_preload_rad"][1][4] += 0.4
    file.write_text(json.dumps(document))
    with pytest.raises(LimitsError, match=f"{NAMES[4]}: the grip's goal moves at .* rad/s"):
        run_trajectory(file, hand_limits(), "sim")


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_a_run_leaves_a_table_of_commands_errors_currents_and_faults(tmp_path, ending):
    bus, driver = simulated(Time())
    log = tmp_path / "runs" / f"swing.{ending}"
    options = RunOptions(log=log, motor_names=bus.names)
    perform(driver, grip_motion(tmp_path), hand_limits(), options)
    if ending == "csv":
        with log.open() as file:
            rows = list(csv.DictReader(file))
    else:
        rows = pq.read_table(log).to_pylist()
    assert len(rows) > 100 and {row["state"] for row in rows} == {"RUNNING", "READY"}
    row = {key: rows[50][key] for key in rows[50]}
    for name in NAMES:
        measured, command, preload = (
            float(row[f"{name}_{what}_rad"]) for what in ("position", "command", "preload")
        )
        nearest = sorted((command, measured, command + preload))[1]
        assert float(row[f"{name}_error_rad"]) == pytest.approx(measured - nearest, abs=1e-12)
    assert all(float(row[f"{motor}_temperature_c"]) == 25 for motor in bus.names)
    assert max(float(row[f"{motor}_current_ma"]) for motor in bus.names) > 0
    assert {"queued_knots", "bad_frames", "gaps", "resends"} < set(row)


def test_a_run_that_fails_leaves_its_table_too(tmp_path):
    log = tmp_path / "failed.parquet"
    _, driver = simulated(Time(), current_ma=1)
    with pytest.raises(Exception, match="draws"):
        perform(driver, grip_motion(tmp_path), hand_limits(), RunOptions(log=log))
    assert pq.read_table(log).num_rows > 0
    assert not list(tmp_path.glob("*.partial"))
