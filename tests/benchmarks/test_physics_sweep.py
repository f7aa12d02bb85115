"""The sweep tries the hand of the files, and tells what became of the tool."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.physics_sweep import FinishedHand, cell
from fpcad.make.trajectory import Trajectory
from fpcad.make.trajectory_file import read_trajectory
from fpcad.simulate.measure import Outcome


@pytest.fixture(scope="module")
def hand(built_clay) -> FinishedHand:
    return FinishedHand(built_clay)


def test_the_specs_own_grip_is_that_of_the_files(hand, built_clay):
    swept = hand.trajectories
    for pose, trajectory in swept.items():
        filed = read_trajectory(built_clay / "trajectories" / f"{pose}.json")
        assert trajectory.position_preload_rad is not None
        assert filed.position_preload_rad is not None
        np.testing.assert_allclose(trajectory.position_rad, filed.position_rad, atol=1e-12)
        np.testing.assert_allclose(
            trajectory.position_preload_rad, filed.position_preload_rad, atol=1e-12
        )


def middle_goal(trajectory: Trajectory) -> np.ndarray:
    """Where the motors' goals lie beyond the joints [rad], half-way."""
    assert trajectory.position_preload_rad is not None
    offset = trajectory.position_preload_rad - trajectory.position_rad
    return offset[len(offset) // 2]


def test_other_tendons_ask_for_other_goals(hand):
    grip = hand.spec.grip.model_copy(update={"tendon_length_mm": 250.0})
    softer = hand.gripping(hand.spec.model_copy(update={"grip": grip}))
    for pose, trajectory in hand.trajectories.items():
        assert np.abs(middle_goal(softer[pose]) - middle_goal(trajectory)).max() > 1e-3


@pytest.mark.parametrize(
    ("held", "tipped_at_s", "told"),
    [(True, None, "0.50"), (True, 1.0, "0.50 tips"), (False, 1.0, "0.50 lost")],
)
def test_a_cell_tells_share_and_fate(held, tipped_at_s, told):
    lost = None if held else 2.0
    assert cell(Outcome(held, lost, tipped_at_s, 60.0, 30.0, 0, 0, (), (), 0, 0)) == told
