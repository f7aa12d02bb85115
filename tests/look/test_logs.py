"""Logs of runs on motors, thinned for the page."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv
import pytest

from fpcad.look.logs import MAX_RUNS, POINTS, run_logs
from fpcad.store import write_table

N = 1000


def log_table(peak_rad: float = 0.1) -> pa.Table:
    """One joint and one motor over 10 s; the joint's error peaks in one sample alone."""
    error = np.zeros(N)
    error[333] = -peak_rad
    empty = pa.nulls(N, pa.float64())
    return pa.table(
        {
            "device_s": np.linspace(5.0, 15.0, N),
            "state": ["RUNNING"] * (N - 1) + ["HOLDING"],
            "cause": ["NONE"] * (N - 1) + ["STALE"],
            "thumb_mcp_flex_position_rad": error,
            "thumb_mcp_flex_command_rad": np.zeros(N),
            "thumb_mcp_flex_error_rad": error,
            "thumb_m1_current_ma": np.full(N, 120.0),
            "thumb_m1_temperature_c": empty,
        }
    )


def write_log(folder: Path, name: str, table: pa.Table, age_s: float = 0.0) -> Path:
    file = folder / "runs" / name
    file.parent.mkdir(exist_ok=True)
    if file.suffix == ".csv":
        pyarrow.csv.write_csv(table, file)
    else:
        write_table(file, table)
    os.utime(file, (1e9 - age_s, 1e9 - age_s))
    return file


@pytest.mark.parametrize("ending", ["parquet", "csv"])
def test_a_log_is_thinned_and_its_extremes_are_those_of_all_samples(tmp_path: Path, ending):
    write_log(tmp_path, f"carve.{ending}", log_table())
    (log,) = run_logs(tmp_path, warnings := [])
    facts = dict(log.facts)
    assert warnings == []
    assert len(log.seconds) == POINTS
    assert log.seconds[[0, -1]] == pytest.approx([0.0, 10.0])
    assert facts["Largest error"] == "5.73 ° (thumb_mcp_flex)"
    assert facts["Largest current"] == "120 mA (thumb_m1)"
    assert facts["Ended"] == "HOLDING: STALE"


def test_what_motors_do_not_tell_is_not_drawn(tmp_path: Path):
    write_log(tmp_path, "carve.parquet", log_table())
    (log,) = run_logs(tmp_path, [])
    assert [q.name for q in log.quantities] == ["error", "measured", "command", "current"]
    assert all(q.values.shape == (1, POINTS) for q in log.quantities)


def test_the_newest_runs_come_first_and_the_others_are_counted(tmp_path: Path):
    for k in range(MAX_RUNS + 2):
        write_log(tmp_path, f"run-{k}.parquet", log_table(), age_s=k)
    logs = run_logs(tmp_path, warnings := [])
    assert [log.name for log in logs] == [f"run-{k}" for k in range(MAX_RUNS)]
    assert warnings == [f"Of {MAX_RUNS + 2} runs' logs the newest {MAX_RUNS} are shown."]


@pytest.mark.parametrize("text", ["half a fi", "", "a,b\n1,2\n", "device_s\n", "device_s\nsoon\n"])
@pytest.mark.parametrize("name", ["bad.parquet", "bad.csv"])
def test_a_log_that_is_none_is_told_and_the_page_goes_on(tmp_path: Path, name, text):
    write_log(tmp_path, "good.parquet", log_table())
    (tmp_path / "runs" / name).write_text(text)
    logs = run_logs(tmp_path, warnings := [])
    assert [log.name for log in logs] == ["good"]
    assert len(warnings) == 1
    assert name in warnings[0]


def test_no_runs_are_no_logs(tmp_path: Path):
    assert run_logs(tmp_path, []) == []
