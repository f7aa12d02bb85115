"""The first hand's poses about to turn, and their paths."""

from __future__ import annotations

import pytest

from fpcad.model.pose import HAND_SIZE
from fpcad.solve.attempt import Workbench
from fpcad.wield.evaluate import build_load, build_mechanism, build_stepping
from fpcad.wield.path import join_traces
from fpcad.wield.trace import trace
from tests.wield.wielding import Wielding


@pytest.fixture(scope="session")
def wielding(bench: Workbench, first_hand) -> dict[str, Wielding]:
    """All poses of the first hand."""
    found = {}
    for pose, y in first_hand.states.items():
        mechanism = build_mechanism(bench, pose, first_hand.design, y)
        load, stepping = build_load(bench.spec, pose), build_stepping(bench.spec)
        x = y[HAND_SIZE:]
        traces = {way: trace(mechanism, load, x, way, stepping) for way in (-1.0, 1.0)}
        path = join_traces(
            pose, bench.kernels[pose].layout, y[:HAND_SIZE], traces[-1.0], traces[1.0]
        )
        found[pose] = Wielding(mechanism, load, stepping, y, traces, path)
    return found
