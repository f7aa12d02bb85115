"""What counts as made of numbers, and what stands for a path or an attempt that is not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fpcad.pipeline import evaluate as stage
from fpcad.pipeline import sample
from fpcad.pipeline.sample import NOT_A_NUMBER
from fpcad.sample.rrt import Proposal
from fpcad.sample.tree import Candidate
from fpcad.solve.attempt import Attempt, SolvedPose
from fpcad.solve.measure import Residual
from fpcad.wield.evaluate import Evaluation
from fpcad.wield.metrics import PathMetrics
from fpcad.wield.path import WieldingPath

PATH = WieldingPath(
    "swing",
    np.array([-0.1, 0.0, 0.1]),
    np.zeros((3, 1, 3)),
    np.zeros((3, 1, 4)),
    np.ones(3),
    np.ones(3),
    np.zeros(6),
    "statics",
    "statics",
)
METRICS = PathMetrics(11.5, 0.2, 900.0, 800.0, 1.5, "statics", "statics")
SOLVED = SolvedPose(np.zeros(4), 0.1, Residual(0.0, 0.0, 1.0, 1.0), 5)


def test_a_sound_path_is_made_of_numbers():
    assert stage.made_of_numbers(PATH, METRICS)


def test_a_path_that_does_not_move_has_no_sliding_and_may_not_be_held():
    still = replace(METRICS, tmr_deg=0.0, mss_mm_s=np.nan, mft_nmm=np.inf, mft_p90_nmm=np.inf)
    assert stage.made_of_numbers(PATH, still)


@pytest.mark.parametrize("field", ["tmr_deg", "mss_mm_s", "mft_nmm", "mft_p90_nmm", "tip_force_n"])
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_no_metric_of_a_path_may_be_lost(field, value):
    assert not stage.made_of_numbers(PATH, replace(METRICS, **{field: value}))


@pytest.mark.parametrize("field", ["tool_angle_rad", "joints_rad", "contacts", "hand_in_tool"])
def test_no_state_of_a_path_may_be_lost(field):
    spoiled = getattr(PATH, field).copy()
    spoiled.flat[1] = np.nan
    assert not stage.made_of_numbers(replace(PATH, **{field: spoiled}), METRICS)


def test_a_pose_that_is_not_made_of_numbers_has_no_path(monkeypatch, bench, clay_space):
    lost = replace(METRICS, mft_nmm=np.nan)
    found = Evaluation({"swing": PATH, "hit": PATH}, {"swing": METRICS, "hit": lost})
    monkeypatch.setattr(stage, "evaluate", lambda *_: found)
    hand = Candidate(0, -1, clay_space.lower, {})
    evaluation = stage.evaluate_candidate(clay_space, bench, hand)
    assert list(evaluation.paths) == ["swing"]
    assert (evaluation.metrics["hit"].tmr_deg, evaluation.metrics["hit"].end_plus) == (
        0.0,
        NOT_A_NUMBER,
    )


@pytest.mark.parametrize(
    "solved", [replace(SOLVED, cost=np.nan), replace(SOLVED, y=np.full(4, np.inf))]
)
def test_an_attempt_that_is_not_made_of_numbers_is_rejected(monkeypatch, bench, clay_space, solved):
    tried = Attempt(clay_space.lower, {"swing": SOLVED, "hit": solved}, "")
    monkeypatch.setattr(sample, "attempt", lambda *_: tried)
    judged = sample.attempt_item(clay_space, bench, (Proposal(0, 0, clay_space.lower), {}))
    assert judged.reason == f"hit: {NOT_A_NUMBER}"
