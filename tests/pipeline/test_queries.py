"""The example queries of docs/scale.md run on a build's files and say what they should."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from fpcad.pipeline.run import run_stages
from fpcad.store import read_json, read_table
from tests.pipeline.small import small_build

DOCUMENT = Path(__file__).parents[2] / "docs" / "scale.md"
QUERIES = re.findall(r"```sql\n(.*?)```", DOCUMENT.read_text(encoding="utf-8"), re.DOTALL)


@pytest.fixture(scope="module")
def build(tmp_path_factory: pytest.TempPathFactory, bench, kernel_cache) -> Path:
    """The small design up to its chosen hand."""
    made = small_build(tmp_path_factory.mktemp("queried"), kernel_cache)
    run_stages(made, "select")
    return made.folder


@pytest.fixture
def ask(build: Path):
    """Ask DuckDB about this build in place of the document's."""
    duckdb = pytest.importorskip("duckdb")
    (pose,) = {n.removesuffix("_tmr_deg") for n in columns(build) if n.endswith("_tmr_deg")}

    def answer(query: str) -> list[tuple]:
        for name in ("carve", "poke", "press"):
            query = query.replace(f"{name}_", f"{pose}_").replace(f"'{name}'", f"'{pose}'")
        return duckdb.sql(query.replace("build/clay", str(build))).fetchall()

    return answer


def columns(build: Path) -> list[str]:
    return read_table(build / "metrics.parquet").column_names


@pytest.mark.parametrize("query", QUERIES)
def test_every_query_has_an_answer(ask, query):
    assert ask(query)


def test_shards_and_tables_hold_the_same_calls(ask, build):
    (accepted,) = ask("SELECT count(*) FROM 'build/clay/calls.parquet' WHERE outcome = 'accepted'")
    shards = "read_parquet('build/clay/store/sample-*/[0-9]*.parquet')"
    assert ask(f"SELECT count(*) FROM {shards} WHERE outcome = 'accepted'") == [accepted]
    counts = read_json(build / "manifest.json")["stages"]["sample"]["counts"]
    assert accepted == (counts["accepted"],)
