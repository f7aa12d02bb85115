"""A hand that cannot be made is out before it can be chosen, and its reason is told."""

from __future__ import annotations

import pyarrow as pa

from fpcad.pipeline.makeable import refuse_early
from fpcad.pipeline.stage import Build
from fpcad.store import read_table


def build_of(folder, spec, bench) -> Build:
    return Build(spec, folder, _bench=bench)


def test_hands_that_can_be_made_stay_as_they_are(built_clay, clay, bench):
    metrics = read_table(built_clay / "store" / "metrics.parquet")
    assert refuse_early(build_of(built_clay, clay, bench), metrics).equals(metrics)


def test_hands_without_room_are_refused_with_the_reason(built_clay, clay, bench):
    thick = clay.print.model_copy(update={"skin_thickness_mm": 9.0})
    spec = clay.model_copy(update={"print": thick})
    metrics = read_table(built_clay / "store" / "metrics.parquet")
    judged = refuse_early(build_of(built_clay, spec, bench), metrics)
    assert judged.schema == metrics.schema
    assert not any(judged["makeable"].to_pylist())
    assert all("needs 26.1 mm, finger is" in reason for reason in judged["reason"].to_pylist())


def test_a_reason_that_stands_is_kept(built_clay, clay, bench):
    metrics = read_table(built_clay / "store" / "metrics.parquet")
    rows = [{**row, "makeable": False, "reason": "broken"} for row in metrics.to_pylist()]
    judged = refuse_early(
        build_of(built_clay, clay, bench), pa.Table.from_pylist(rows, metrics.schema)
    )
    assert set(judged["reason"].to_pylist()) == {"broken"}
