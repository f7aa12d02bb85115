"""A run on simulated motors that says when it moves, for a test that interrupts it."""

from __future__ import annotations

import sys
from pathlib import Path

from fpcad.run.drivers.sim import SimBus
from fpcad.run.errors import RunError
from fpcad.run.options import RunOptions
from fpcad.run.run_trajectory import run_on_servos
from fpcad.run.servo_guard import ServoGuards
from tests.run.drivers.rigs import MOTORS, motor_map, mounting, tendon_hand
from tests.run.fixtures import hand_limits, swing, write_trajectory


def main() -> None:
    file = write_trajectory(Path(sys.argv[1]), swing(6.0, 181))
    told: list[int] = []

    def tell(progress) -> None:
        if progress.path_s > 0.2 and not told:
            told.append(1)
            print("moving", flush=True)

    bus = SimBus(MOTORS, tendon_hand(), mounting())
    options = RunOptions(on_progress=tell)
    try:
        run_on_servos(file, hand_limits(), bus, motor_map(), ServoGuards(2000), options)
    except RunError as error:
        print(error)
        sys.exit(error.exit_code)


if __name__ == "__main__":
    main()
