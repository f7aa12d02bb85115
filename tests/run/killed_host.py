"""A host that is meant to be killed: runs a trajectory on a port that it is given the file of."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from fpcad.run.run_trajectory import SIMULATED_PORTS, run_trajectory
from tests.run.fixtures import hand_limits, swing, write_trajectory


def main(folder: Path, port_name: str) -> None:
    knots = swing(6.0, 151)
    file = write_trajectory(folder, knots)
    start = np.array(knots.position[0])
    controller = SIMULATED_PORTS[port_name]
    with controller(hand_limits(), start, record=folder / "record") as device:
        print(device.pid, flush=True)
        run_trajectory(
            file, hand_limits(), device.port, on_progress=lambda p: print(p.path_s, flush=True)
        )


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
