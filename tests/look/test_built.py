"""What the summary tells of the hand that was made: refusals, checks, torques."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pyarrow as pa
import pytest

from fpcad.look.built import (
    check_warnings,
    checks,
    loads,
    parts_list,
    refusals,
    torque_warnings,
)
from fpcad.look.document import build_document
from fpcad.look.run import Run, load
from fpcad.look.words import summarize
from fpcad.spec.schema import Spec
from fpcad.store import write_whole
from tests.look.made_up import STAGES, write_made_up_run, write_manifest

FOUND = """gate,severity,part,value,limit,unit,x_mm,y_mm,z_mm,text
meetings,figure,"palm, index_mcp",0.4,0,mm,,,,clearance of 0.40 mm at rest
walls,warning,palm,0.9,1.2,mm,1,2,3,a wall of 0.90 mm where 1.20 mm are asked for
"""


@pytest.fixture
def exported(clay: Spec, tmp_path: Path) -> Run:
    folder = write_made_up_run(tmp_path / "clay", clay, 12)
    write_manifest(folder, dict.fromkeys((*STAGES, "export"), "done"))
    write_whole(folder / "parts" / "checks.csv", FOUND)
    write_whole(folder / "parts" / "bom.csv", "item,count,mass_g,hours,hand\npalm,1,39.31,,4\n")
    return load(folder)


def with_reasons(run: Run, reasons: list[str]) -> Run:
    """The run with its first hands refused for these reasons."""
    told = reasons + [""] * (run.metrics.num_rows - len(reasons))
    metrics = run.metrics.drop_columns(["makeable", "reason"])
    metrics = metrics.append_column("makeable", pa.array([not reason for reason in told]))
    return replace(run, metrics=metrics.append_column("reason", pa.array(told)))


def test_warnings_of_the_gates_stand_at_the_top_and_figures_do_not(exported: Run):
    told = summarize(exported, build_document(exported)[0])
    assert "palm: a wall of 0.90 mm where 1.20 mm are asked for." in told.warnings
    assert not any("clearance" in warning for warning in told.warnings)
    assert [row["severity"] for row in told.checks] == ["warning", "figure"]
    assert told.parts == [{"item": "palm", "count": "1", "mass [g]": "39.31"}]


def test_many_warnings_of_the_gates_are_one_at_the_top(exported: Run):
    row = "walls,warning,palm,0.9,1.2,mm,1,2,3,a wall of 0.90 mm\n"
    write_whole(exported.folder / "parts" / "checks.csv", FOUND + 4 * row)
    (told,) = check_warnings(exported)
    assert "warn 5 times; the first: palm: a wall of 0.90 mm where" in told


def test_loads_are_listed_the_heaviest_first(exported: Run):
    text = (
        "pose,case,what,where,load,limit,unit,share,at_deg\n"
        "carve,gripping,strand,m1 strand,60,300,N,0.200,12.0\n"
        "poke,gripping,bearing,IP ball MR63,111,74,N,1.500,\n"
    )
    write_whole(exported.folder / "parts" / "loads.csv", text)
    assert [row["where"] for row in loads(exported)] == ["IP ball MR63", "m1 strand"]
    told = summarize(exported, build_document(exported)[0])
    assert told.loads == loads(exported) and told.load_count == 2
    assert told.warnings[0] == (
        "In 1 place the hand bears more than it may; the worst: IP ball MR63, bearing of 111 N in "
        "poke (gripping), 74 N are allowed."
    )


def test_what_was_left_by_an_export_that_is_not_done_is_not_told(exported: Run):
    write_manifest(exported.folder, {**dict.fromkeys(STAGES, "done"), "export": "running"})
    run = load(exported.folder)
    assert checks(run) == parts_list(run) == loads(run) == []


def test_refusals_are_counted_by_their_reason(exported: Run):
    run = with_reasons(exported, ["too thin", "no motor fits", "too thin"])
    assert refusals(run) == [("too thin", 2, [0, 2]), ("no motor fits", 1, [1])]
    told = summarize(run, build_document(run)[0])
    assert ("Makeable", "3 hands are refused") in told.run


def test_many_reasons_are_summed_up(exported: Run):
    run = with_reasons(exported, [f"reason {k}" for k in range(12)])
    assert refusals(run)[-1] == ("2 more reasons", 2, [])


def test_weak_motors_are_told_with_figures(exported: Run):
    torque = {
        "carve": {"held_tip_force_n": 1.13, "tip_force_n": 10.0},
        "poke": {"held_tip_force_n": 11.0, "tip_force_n": 10.0},
    }
    assert exported.selected is not None
    run = replace(exported, selected={**exported.selected, "motor": "small", "torque": torque})
    assert torque_warnings(run) == [
        "small motors hold less at the tip than asked: 1.1 N of 10 N in carve."
    ]
    assert torque_warnings(exported) == []
