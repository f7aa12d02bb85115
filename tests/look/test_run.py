"""Runs that are finished, empty, stopped or old: each is opened, or refused in a sentence."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

import fpcad
from fpcad.errors import StoreError
from fpcad.look.report import report_page
from fpcad.look.run import Run, load
from fpcad.look.unfinished import EMPTY, MEASURING, SAMPLING
from fpcad.spec.dump import dump_spec
from fpcad.spec.schema import Spec
from fpcad.store import read_json, read_table, write_json, write_table
from tests.look.made_up import write_made_up_run, write_manifest


def copied(run: Run, target: Path) -> Path:
    return Path(shutil.copytree(run.folder, target))


def stopped(built: Path, folder: Path, stage: str, shards: int | None = None) -> Path:
    """A copy of a finished build as a kill in a stage would have left it."""
    shutil.copytree(built, folder)
    order = ("solve", "sample", "evaluate", "select", "export", "report")
    manifest = read_json(folder / "manifest.json")
    for late in order[order.index(stage) + 1 :]:
        manifest["stages"].pop(late, None)
    manifest["stages"][stage] |= {"status": "running"}
    write_json(folder / "manifest.json", manifest)
    if shards is not None:
        for file in sorted((folder / "store").glob(f"{stage}-*/[0-9]*.parquet"))[shards:]:
            file.unlink()
    return folder


def test_tables_of_a_run_are_joined_by_id(made_up: Run):
    table = fpcad.load(made_up.folder).table
    assert table["id"].to_pylist() == list(range(60))
    assert {"d1_distal_length_mm", "mean_score", "pareto"} <= set(table.column_names)


def test_a_run_is_a_pandas_frame_too(made_up: Run):
    frame = made_up.frame()
    assert frame.index.name == "id"
    assert len(frame) == 60


def test_every_pose_has_its_metrics_and_scores(made_up: Run):
    assert len(made_up.metric_columns) == 5 * len(made_up.poses)
    assert len(made_up.score_columns) == 3 * len(made_up.poses)


def test_a_real_run_has_no_warnings(real_run: Run):
    assert real_run.warnings == ()
    assert real_run.selected is not None


def test_paths_of_a_hand_are_read_by_its_id(real_run: Run):
    assert real_run.selected is not None
    paths = real_run.paths(real_run.selected["id"])
    assert set(paths["pose"].to_pylist()) == set(real_run.poses)
    assert real_run.paths(10**6).num_rows == 0


def test_no_folder_is_told(tmp_path: Path):
    with pytest.raises(StoreError, match="no run here"):
        load(tmp_path / "nothing")


@pytest.mark.parametrize("hands", [0, 1, 2])
def test_a_run_of_no_one_or_two_hands_has_a_page(clay: Spec, tmp_path: Path, hands):
    folder = tmp_path / "clay"
    if hands:
        write_made_up_run(folder, clay, hands)
    else:
        folder.mkdir()
        (folder / "spec.yaml").write_text(dump_spec(clay), encoding="utf-8")
        write_manifest(folder, {})
    run = load(folder)
    assert len(run.ids) == hands
    assert (EMPTY in run.warnings) == (hands == 0)
    assert "<h1>clay</h1>" in report_page(run)


def test_a_run_stopped_while_sampling_shows_its_finished_shards(built_clay: Path, tmp_path: Path):
    run = load(stopped(built_clay, tmp_path / "clay", "sample"))
    assert SAMPLING in run.warnings
    assert len(run.ids) == load(built_clay).candidates.num_rows
    assert run.metrics.num_rows == 0
    assert run.selected is None
    assert "Sampling was stopped" in report_page(run)


def test_a_run_stopped_in_its_first_batch_has_its_first_hand(built_clay: Path, tmp_path: Path):
    run = load(stopped(built_clay, tmp_path / "clay", "sample", shards=0))
    assert run.ids.tolist() == [0]
    assert run.calls.num_rows == 0


def test_a_run_stopped_while_measuring_scores_what_is_measured(built_clay: Path, tmp_path: Path):
    run = load(stopped(built_clay, tmp_path / "clay", "evaluate"))
    assert MEASURING in run.warnings
    assert run.selected is None
    assert np.isfinite(run.matrix(["mean_score"])).any()
    assert "Measuring was stopped" in report_page(run)


def test_a_run_stopped_before_measuring_shows_the_hands(built_clay: Path, tmp_path: Path):
    run = load(stopped(built_clay, tmp_path / "clay", "evaluate", shards=0))
    assert run.metrics.num_rows == 0
    assert not run.front.any()
    assert "Measuring was stopped" in report_page(run)


def test_a_run_stopped_while_exporting_shows_the_choice(built_clay: Path, tmp_path: Path):
    run = load(stopped(built_clay, tmp_path / "clay", "export"))
    assert run.selected is not None
    assert "Chosen: hand" in report_page(run)


def test_a_spec_of_another_version_is_told(made_up: Run, tmp_path: Path):
    folder = copied(made_up, tmp_path / "clay")
    (folder / "spec.yaml").write_text("fpcad: 99\nname: clay\n", encoding="utf-8")
    with pytest.raises(StoreError, match=r"made by fpcad 0\.1\.0, not readable by .* spec\.yaml"):
        load(folder)


@pytest.mark.parametrize(
    ("file", "column"),
    [("candidates", "d4_finger_diameter_mm"), ("calls", "reason"), ("calls", "candidate")],
)
def test_tables_of_another_version_are_told(made_up: Run, tmp_path: Path, file, column):
    folder = copied(made_up, tmp_path / "clay")
    table = read_table(folder / f"{file}.parquet").drop_columns([column])
    write_table(folder / f"{file}.parquet", table)
    with pytest.raises(
        StoreError, match=f"made by fpcad .*{file}.parquet has no column `{column}`"
    ):
        load(folder)


@pytest.mark.parametrize("file", ["manifest.json", "candidates.parquet", "metrics.parquet"])
def test_a_damaged_file_is_named(made_up: Run, tmp_path: Path, file):
    folder = copied(made_up, tmp_path / "clay")
    (folder / file).write_bytes(b"half a fi")
    with pytest.raises(StoreError, match=file):
        load(folder)
