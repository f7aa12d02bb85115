"""What becomes of a chosen hand that turns out to be one that cannot be made."""

from __future__ import annotations

from fpcad.errors import MakeError
from fpcad.pipeline import export as stage
from fpcad.pipeline.run import run_stages
from fpcad.pipeline.select import METRICS, SELECTED
from fpcad.store import read_json, read_table
from tests.pipeline.small import small_build


def test_a_hand_that_cannot_be_made_gives_way_to_the_next_best(
    tmp_path, bench, kernel_cache, monkeypatch
):
    """Modelling itself is left out: it takes a minute, and other tests make hands."""
    asked: list[int] = []

    def made(task, order, cpu_s, progress):
        _, _, out, _, candidate = order
        asked.append(candidate)
        files = [
            out / name for name in ("hand/transmission.yaml", "parts/bom.csv", "parts/old.stl")
        ]
        for file in files:
            file.parent.mkdir(parents=True, exist_ok=True)
            file.touch()
        if len(asked) < 3:
            raise MakeError(f"a wall of 0.{len(asked)} mm")
        return files[:2]

    monkeypatch.setattr(stage, "run_apart", made)
    build = small_build(tmp_path, kernel_cache)
    sampling = build.spec.sampling.model_copy(update={"candidates": 4})
    build.spec = build.spec.model_copy(update={"sampling": sampling})
    counts = run_stages(build, "export")["stages"]["export"]["counts"]
    assert len(set(asked)) == 3 and counts["selected"] == asked[-1] and counts["refused"] == 2
    assert read_json(build.folder / SELECTED)["id"] == asked[-1]
    rows = {row["id"]: row for row in read_table(build.folder / METRICS).to_pylist()}
    told = [rows[candidate]["reason"] for candidate in asked]
    assert told == ["a wall of 0.1 mm", "a wall of 0.2 mm", ""]
    assert [rows[candidate]["makeable"] for candidate in asked] == [False, False, True]
    assert not (build.folder / "parts" / "old.stl").exists()  # of a hand that was refused
