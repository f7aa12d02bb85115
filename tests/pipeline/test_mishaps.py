"""A hand whose task raises, crashes or loses its numbers is recorded and harms no other."""

from __future__ import annotations

import math
import shutil
from pathlib import Path

import pytest

from fpcad.pipeline.run import run_stages
from fpcad.sample.rrt import ACCEPTED
from fpcad.store import read_json, read_table
from tests.pipeline.saboteurs import MISHAPS, hire_saboteurs
from tests.pipeline.small import small_build

REASONS = {
    3: "raised ZeroDivisionError: division by zero",
    5: "crashed: exit code 1",
    7: "crashed: SIGSEGV",
}


@pytest.fixture(scope="module")
def healthy(tmp_path_factory: pytest.TempPathFactory, bench, kernel_cache) -> Path:
    """The small design, made without mishaps."""
    build = small_build(tmp_path_factory.mktemp("healthy"), kernel_cache)
    run_stages(build, "select")
    return build.folder


@pytest.fixture(scope="module")
def harmed(tmp_path_factory: pytest.TempPathFactory, healthy: Path, kernel_cache) -> Path:
    """The same hands, evaluated by saboteurs."""
    build = small_build(tmp_path_factory.mktemp("harmed"), kernel_cache, 2, hire=hire_saboteurs)
    shutil.copytree(healthy, build.folder)
    for shards in build.folder.glob("store/evaluate-*"):
        shutil.rmtree(shards)
    run_stages(build, "evaluate", force=True)
    run_stages(build, "select")
    return build.folder


def rows(folder: Path, table: str) -> list[dict]:
    return read_table(folder / table).to_pylist()


def test_evaluation_records_what_befell_each_hand(harmed):
    found = {row["id"]: row for row in rows(harmed, "metrics.parquet")}
    (pose,) = (name.removesuffix("_tmr_deg") for name in found[0] if name.endswith("_tmr_deg"))
    for hand in MISHAPS:
        row = found[hand]
        assert row[f"{pose}_tmr_deg"] == 0
        assert math.isnan(row[f"{pose}_mft_nmm"])
        assert (row["makeable"], row["pareto"], row["mean_score"]) == (False, False, 0)
        if hand in REASONS:
            assert row["reason"] == f"{pose}: {REASONS[hand]}"
            assert row[f"{pose}_end_plus"] == row[f"{pose}_end_minus"] == REASONS[hand]
        else:
            assert row["reason"]


def test_evaluation_of_the_other_hands_is_what_it_was(healthy, harmed):
    before, after = (rows(folder, "store/metrics.parquet") for folder in (healthy, harmed))
    assert [row["id"] for row in after] == [row["id"] for row in before]
    others = [place for place, row in enumerate(before) if row["id"] not in MISHAPS]
    assert [after[place] for place in others] == [before[place] for place in others]


def test_a_failed_hand_is_not_chosen(harmed):
    assert read_json(harmed / "selected.json")["id"] not in MISHAPS
    assert not MISHAPS.keys() & {row["id"] for row in rows(harmed, "paths.parquet")}


def test_sampling_rejects_calls_that_fail(tmp_path, kernel_cache):
    build = small_build(tmp_path, kernel_cache, 2, hire=hire_saboteurs)
    manifest = run_stages(build, "sample")
    outcomes = {
        row["number"]: row["reason"] or row["outcome"]
        for row in rows(build.folder, "calls.parquet")
    }
    assert {call: outcomes[call] for call in REASONS} == REASONS
    assert outcomes[13] not in (ACCEPTED, "")
    assert manifest["stages"]["sample"]["counts"]["candidates"] == build.spec.sampling.candidates
