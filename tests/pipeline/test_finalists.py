"""Hands tried in physics before one is chosen: columns, resumption, workers, refusals."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest

from fpcad.errors import ToolchainError
from fpcad.pipeline import finalists
from fpcad.pipeline.run import run_stages
from fpcad.pipeline.select import METRICS, SELECT, SELECTED, refuse
from fpcad.pipeline.stage import Build
from fpcad.store import read_json
from tests.pipeline.small import small_build

HANDS, FINALISTS = 4, 2


def build_of(root: Path, kernels: Path, workers: int = 1) -> Build:
    """The small design with few hands, of which physics tries some."""
    build = small_build(root, kernels, workers)
    selection = build.spec.selection.model_copy(update={"simulate": FINALISTS})
    sampling = build.spec.sampling.model_copy(update={"candidates": HANDS})
    build.spec = build.spec.model_copy(update={"selection": selection, "sampling": sampling})
    return build


@pytest.fixture(scope="module")
def tried(tmp_path_factory, bench, kernel_cache) -> Build:
    build = build_of(tmp_path_factory.mktemp("tried"), kernel_cache)
    run_stages(build, "select")
    return build


def outputs(build: Build) -> list[bytes]:
    return [(build.folder / name).read_bytes() for name in (METRICS, SELECTED)]


def test_finalists_have_shares_and_others_have_none(tried: Build):
    table = pq.read_table(tried.folder / METRICS)
    columns = finalists.share_columns(tried)
    assert len(columns) == 2 * len(tried.spec.poses)
    for column in columns:
        shares = table[column].drop_null().to_numpy()
        assert len(shares) == FINALISTS
        assert np.all((shares >= 0.0) & (shares <= 1.0)) and shares.max() > 0.5
    chosen = read_json(tried.folder / SELECTED)
    assert "farthest in physics" in chosen["reason"]
    assert table[columns[0]][table["id"].to_pylist().index(chosen["id"])].is_valid


def test_two_workers_and_a_run_that_was_stopped_end_alike(tried: Build, tmp_path, kernel_cache):
    """The first result is there already; it is that of the other run, and so is the end."""
    other = build_of(tmp_path, kernel_cache, workers=2)
    run_stages(other, "evaluate")
    first = tried.shards("select").files()[0]
    shards = other.shards("select").folder
    shards.mkdir(parents=True)
    (shards / first.name).write_bytes(first.read_bytes())
    run_stages(other, "select")
    assert outputs(other) == outputs(tried)


def test_a_refused_finalist_makes_room_for_one_more(tried: Build, tmp_path, kernel_cache):
    build = build_of(tmp_path, kernel_cache)
    build.keys = dict(tried.keys)
    shutil.copytree(tried.folder, build.folder)
    before = read_json(build.folder / SELECTED)["id"]
    refuse(build, before, "too small")
    table = pq.read_table(build.folder / METRICS)
    column = table[finalists.share_columns(build)[0]].to_pylist()
    assert read_json(build.folder / SELECTED)["id"] != before
    assert column[table["id"].to_pylist().index(before)] is None
    assert sum(value is not None for value in column) == FINALISTS


def test_mujoco_is_asked_for_before_anything_is_made(tmp_path, kernel_cache, monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    build = build_of(tmp_path, kernel_cache)
    with pytest.raises(ToolchainError, match=r"fpcad\[physics\]"):
        run_stages(build, "solve")
    assert not build.folder.exists()


def test_the_grip_matters_to_the_choice_only_where_physics_is_asked(clay):
    def key(simulate: int, force: float) -> str:
        selection = clay.selection.model_copy(update={"simulate": simulate})
        grip = clay.grip.model_copy(update={"min_normal_force_n": force})
        return SELECT.key(clay.model_copy(update={"selection": selection, "grip": grip}), "")

    assert key(0, 1.0) == key(0, 2.0)
    assert key(5, 1.0) != key(5, 2.0)
