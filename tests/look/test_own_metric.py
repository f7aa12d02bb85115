"""A user's own metric, one function of an installed package, on everything that fpcad shows."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from fpcad.spec.dump import dump_spec
from fpcad.spec.schema import Spec
from fpcad.store import read_json, write_whole

PACKAGE = """
from fpcad.wield.plugins import scored

@scored("smaller", resolution=0.01)
def joint_travel_rad(path):
    return float(abs(path.joints_rad[1:] - path.joints_rad[:-1]).sum())
"""
METADATA = "Metadata-Version: 2.1\nName: their-package\nVersion: 1.0\n"
ENTRY_POINTS = "[fpcad.metrics]\njoint_travel_rad = their_package:joint_travel_rad\n"


@pytest.fixture(scope="module")
def folder(clay: Spec, built_clay: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An installed package, a spec of three hands, and formulas that are compiled already."""
    folder = tmp_path_factory.mktemp("own-metric")
    write_whole(folder / "site" / "their_package.py", PACKAGE)
    installed = folder / "site" / "their_package-1.0.dist-info"
    write_whole(installed / "METADATA", METADATA)
    write_whole(installed / "entry_points.txt", ENTRY_POINTS)
    sampling = clay.sampling.model_copy(update={"candidates": 3})
    write_whole(folder / "clay.yaml", dump_spec(clay.model_copy(update={"sampling": sampling})))
    (folder / "build").mkdir()
    (folder / "build" / ".kernels").symlink_to(built_clay.parent / ".kernels")
    fpcad(folder, "select", str(folder / "clay.yaml"), "--workers", "2")
    return folder


def fpcad(folder: Path, *words: str) -> str:
    """What a verb prints where the package is installed."""
    path = os.pathsep.join([str(folder / "site"), str(Path(__file__).parents[2])])
    told = subprocess.run(
        [sys.executable, "-m", "fpcad", *words, "--build", str(folder / "build")],
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
        check=False,
    )
    assert told.returncode == 0, told.stderr
    return told.stdout


def test_it_is_in_tables_and_scored(folder: Path, clay: Spec):
    columns = [f"{pose}_joint_travel_rad{end}" for pose in clay.poses for end in ("", "_score")]
    rows = fpcad(folder, "table", "clay", "--columns", ",".join(columns)).splitlines()
    values = [[float(value) for value in row.split(",")] for row in rows[1:]]
    assert len(values) == 3
    for k in range(0, len(columns), 2):
        least = min(values, key=lambda row: row[k])
        assert least[k + 1] == 100.0
        assert all(row[k] > 0.1 for row in values)


def test_the_choice_counts_it(folder: Path, clay: Spec):
    scores = read_json(folder / "build" / "clay" / "selected.json")["scores"]
    assert {f"{pose}_joint_travel_rad_score" for pose in clay.poses} <= set(scores)


def test_it_is_in_plots(folder: Path):
    fpcad(folder, "plot", "clay", "--out", str(folder / "figures"))
    for name in ("landscapes", "parallel"):
        drawn = (folder / "figures" / f"{name}.svg").read_text(encoding="utf-8")
        assert "joint travel" in drawn


def test_it_is_on_the_page(folder: Path, clay: Spec):
    fpcad(folder, "report", "clay")
    page = (folder / "build" / "clay" / "report.html").read_text(encoding="utf-8")
    named = set(re.findall(r'"name":"(\w+_joint_travel_rad\w*)"', page))
    assert named == {f"{p}_joint_travel_rad{end}" for p in clay.poses for end in ("", "_score")}
    assert "joint travel" in page
