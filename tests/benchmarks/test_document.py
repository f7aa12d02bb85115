import numpy as np
import pytest

from benchmarks.paper.document import write_document
from benchmarks.paper.document_reasons import calls_that_fail
from benchmarks.paper.experiment import Experiment, runs
from benchmarks.paper.packing import Filling
from benchmarks.paper.pictures import draw_curves
from benchmarks.paper.published import FULL, PLANE
from benchmarks.paper.recheck import LIMITS, Recheck
from benchmarks.paper.recheck_ipopt import PoseComparison
from benchmarks.paper.results import Results, outcome
from fpcad.store import write_json


@pytest.fixture(scope="module")
def results(built_clay):
    plane = outcome(Experiment("paper-2d", "2D, ours"), PLANE, built_clay)
    full = outcome(Experiment("paper-6d", "6D, ours"), FULL, built_clay)
    examined = {
        "hand": 0, "pose": "hold", "held": 2, "moved": 0.0, "cost": 0.1,
        "tmr_on_deg": 12.0, "tmr_off_deg": 50.0,
    }  # fmt: skip
    return Results(
        plane,
        plane,
        full,
        [Filling(0.05, 500, 6000, 600)],
        {"candidates": [examined]},
        Recheck(8, 24, dict.fromkeys(LIMITS, 0.0), dict.fromkeys(LIMITS, 24), 1.0),
        {"hold": PoseComparison(2, np.array([1.0, 1.2]), np.array([1.0, 1.0]))},
        trial=8,
    )


def test_the_document_tells_our_numbers_beside_the_papers(results):
    text = write_document(results, "images/curves.png")
    assert "| candidates | 785 | 8 | 8 | 10,000 | 8 |" in text
    assert "**A trial with at most 8 candidates" in text
    assert "| 0.05 | 500 | 6,000 | 600 |" in text
    assert "| hold | 2 of 2 | 1 of 2 | 0 of 2 |" in text
    assert "nan" not in text


def test_the_tally_counts_every_call_once(results):
    t = results.full.tally
    assert sum(t.outcomes.values()) == t.calls
    assert t.outcomes["accepted"] == t.candidates - 1
    assert calls_that_fail(results.full) <= t.calls - t.outcomes["accepted"]
    assert t.efficiency_after(t.calls)[0] == t.efficiency
    assert t.beyond("all", 0) == min(t.beyond(pose, 0) for pose in t.ends)
    assert all(ends.total() == 2 * t.candidates for ends in t.ends.values())


def test_the_curves_are_drawn(results, tmp_path):
    pytest.importorskip("matplotlib")
    draw_curves(results, tmp_path / "curves.png")
    assert (tmp_path / "curves.png").read_bytes().startswith(b"\x89PNG")


def test_trials_and_variants_have_builds_of_their_own():
    experiment = Experiment("paper-2d", "", "-calls", {"min_efficiency": 0.0, "max_calls": 5})
    whole, trial = experiment.spec(None), experiment.spec(100)
    assert (whole.name, trial.name) == ("paper-2d-calls", "paper-2d-calls-100")
    assert whole.sampling.candidates == 2000 and trial.sampling.candidates == 100
    assert whole.sampling.max_calls == 5
    assert Experiment("paper-6d", "").spec(None).sampling.candidates == FULL.candidates


def test_runs_of_another_tree_do_not_count(tmp_path):
    write_json(tmp_path / "manifest.json", {"stages": {"sample": {"key": "new"}}})
    write_json(tmp_path / "experiment.json", [{"key": "old"}, {"key": "new", "seconds": 1.0}])
    assert runs(tmp_path) == [{"key": "new", "seconds": 1.0}]
    assert runs(tmp_path / "none") == []
