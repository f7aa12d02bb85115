"""Metrics that another package brings: they reach tables, scores and pages without a change here."""

from __future__ import annotations

import math
import sys
from importlib.metadata import EntryPoint, EntryPoints
from pathlib import Path
from types import ModuleType

import numpy as np
import pyarrow as pa
import pytest

from fpcad.errors import ToolchainError
from fpcad.wield.path import WieldingPath
from fpcad.wield.plugins import GROUP, PathMetric, installed_metrics, measured, scored


@scored("smaller", resolution=0.01)
def joint_travel_rad(path: WieldingPath) -> float:
    return float(np.abs(np.diff(path.joints_rad, axis=0)).sum())


def states(path: WieldingPath) -> float:
    return len(path.tool_angle_rad)


def install(monkeypatch: pytest.MonkeyPatch, **functions: object) -> None:
    """Have entry points name functions, as an installed package would."""
    module = ModuleType("their_package")
    module.__dict__.update(functions)
    monkeypatch.setitem(sys.modules, "their_package", module)
    points = EntryPoints(EntryPoint(name, f"their_package:{name}", GROUP) for name in functions)
    monkeypatch.setattr("fpcad.wield.plugins.entry_points", lambda group: points)


def path_of(n: int) -> WieldingPath:
    angles = np.linspace(0.0, 1.0, n)
    joints = np.tile(angles[:, None, None], (1, 4, 3))
    zeros = np.zeros(n)
    return WieldingPath(
        "any", angles, joints, np.zeros((n, 2, 4)), zeros, zeros, np.zeros(6), "limits", "limits"
    )


def test_nothing_is_installed_here():
    assert installed_metrics() == ()


def test_installed_functions_are_metrics(monkeypatch):
    install(monkeypatch, states=states, joint_travel_rad=joint_travel_rad)
    travel, count = installed_metrics()
    assert (travel.name, travel.better, travel.resolution) == ("joint_travel_rad", "smaller", 0.01)
    assert (count.name, count.better) == ("states", None)
    assert travel.at(path_of(5)) == pytest.approx(12.0)
    assert count.at(path_of(5)) == 5.0


def test_a_path_that_is_not_there_or_never_moved_has_no_metric():
    metrics = [PathMetric("states", states)]
    assert math.isnan(measured(metrics, None, True)[0])
    assert math.isnan(measured(metrics, path_of(1), False)[0])
    assert measured(metrics, path_of(3), True) == [3.0]


@pytest.mark.parametrize("name", ["tmr_deg", "Travel", "travel mm", "travel_score"])
def test_a_name_that_is_taken_or_not_allowed_is_refused(monkeypatch, name):
    install(monkeypatch, **{name: states})
    with pytest.raises(ToolchainError, match="name"):
        installed_metrics()


def test_a_metric_that_cannot_be_loaded_is_named(monkeypatch):
    install(monkeypatch, states=states)
    monkeypatch.delattr("their_package.states")
    with pytest.raises(ToolchainError, match="metric states"):
        installed_metrics()


@pytest.mark.parametrize("value", [math.inf, "far", None])
def test_what_is_not_a_number_is_refused(value):
    with pytest.raises(ToolchainError, match="gave"):
        PathMetric("odd", lambda _: value).at(path_of(2))


def test_another_function_is_another_metric():
    first, second = PathMetric("a", states), PathMetric("a", joint_travel_rad)
    assert first.fingerprint() == PathMetric("a", states).fingerprint()
    assert first.fingerprint() != second.fingerprint()
    assert first.fingerprint() != PathMetric("a", states, "larger").fingerprint()


def test_scores_need_a_direction_and_a_resolution():
    with pytest.raises(ValueError, match="larger"):
        scored("smaller", resolution=0.0)


def test_a_run_holds_scores_and_shows_the_metric(monkeypatch, built_clay: Path, clay, tmp_path):
    from fpcad.look.report import report_page
    from fpcad.look.run import load
    from fpcad.pipeline.run import run_stages
    from fpcad.pipeline.stage import Build

    install(monkeypatch, states=states, joint_travel_rad=joint_travel_rad)
    sampling = clay.sampling.model_copy(update={"candidates": 2})
    spec = clay.model_copy(update={"sampling": sampling})
    (tmp_path / ".kernels").symlink_to(built_clay.parent / ".kernels", target_is_directory=True)
    run_stages(Build(spec, tmp_path / "clay", workers=1), "select")
    run = load(tmp_path / "clay")
    table: pa.Table = run.table
    for pose in run.poses:
        assert table[f"{pose}_states"].to_numpy().min() > 10
        assert {0.0, 100.0} >= set(table[f"{pose}_joint_travel_rad_score"].to_pylist())
        assert f"{pose}_states_score" not in table.column_names
    assert len(run.score_columns) == 4 * len(run.poses)
    assert run.selected is not None
    assert f"{run.poses[0]}_joint_travel_rad_score" in run.selected["scores"]
    assert "joint travel" in report_page(run)
