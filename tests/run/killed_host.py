"""A host that is meant to be killed: runs a trajectory on a port that it is given the file of."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from fpcad.run.run_trajectory import run_trajectory
from fpcad.run.sim.spawn import simulated_controller
from tests.run.fixtures import hand_limits, swing, write_trajectory


def main(folder: Path) -> None:
    knots = swing(6.0, 151)
    file = write_trajectory(folder, knots)
    start = np.array(knots.position[0])
    with simulated_controller(hand_limits(), start, record=folder / "record.npz") as device:
        print(device.pid, flush=True)
        run_trajectory(
            file, hand_limits(), device.port, on_progress=lambda p: print(p.path_s, flush=True)
        )


if __name__ == "__main__":
    main(Path(sys.argv[1]))
