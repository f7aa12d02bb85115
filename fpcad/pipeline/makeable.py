"""Which candidates can surely not be made, told before any of them is chosen."""

from __future__ import annotations

from typing import Any

import pyarrow as pa

from fpcad.errors import MakeError
from fpcad.make.gates.early import check_early
from fpcad.model.geometry import hand_geometry
from fpcad.pipeline.sample import read_candidates
from fpcad.pipeline.stage import Build
from fpcad.sample.space import design_space


def refuse_early(build: Build, metrics: pa.Table) -> pa.Table:
    """The metrics with `makeable` and `reason` of those that cannot be made, about 6 ms a hand."""
    space, template = design_space(build.spec.hand), build.bench.template
    designs = {c.id: space.internal(c.named) for c in read_candidates(build)}

    def judged(row: dict[str, Any]) -> dict[str, Any]:
        try:
            check_early(build.spec, hand_geometry(template, designs[row["id"]]))
        except MakeError as error:
            return {**row, "makeable": False, "reason": str(error)}
        return row

    rows = [judged(row) if row["makeable"] else row for row in metrics.to_pylist()]
    return pa.Table.from_pylist(rows, metrics.schema)
