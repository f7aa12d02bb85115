"""One rig a driver: the bus under test, the truth about its axes, and ways to harm it."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from typing import Any

import numpy as np

from fpcad.run.bus import MotorBus
from fpcad.run.drivers.dynamixel import DynamixelBus
from fpcad.run.drivers.feetech import FeetechBus
from fpcad.run.drivers.fw import ControllerBus
from fpcad.run.drivers.sim import SimBus
from fpcad.run.limits import JointLimits
from fpcad.run.motor_map import MotorMap, Mounting
from fpcad.run.port import open_port
from fpcad.run.run_trajectory import SIMULATED_PORTS
from fpcad.run.sim.spawn import Mishap
from fpcad.run.sim.tendon_hand import TendonHand, TendonPhysics
from fpcad.run.transmission import Transmission
from tests.run.fixtures import NAMES, hand_limits, swing
from tests.run.servos.bench import ServoBench
from tests.run.servos.dynamixel import DynamixelBench
from tests.run.servos.feetech import FeetechBench

MOTORS = tuple(f"{f}_m{i}" for f in ("thumb", "index", "middle", "ring") for i in (1, 2, 3))
NUMBERS = tuple(range(1, 13))
GEARS = Transmission(
    np.kron(np.eye(4), [[1, 1, 0], [1, -1, 0], [0.4, 0, 0.5]]).astype(np.float64), np.zeros(12)
)
START = swing().position[0]
SERVOS = {
    "dynamixel": (DynamixelBench, DynamixelBus, "XL330-M288"),
    "feetech": (FeetechBench, FeetechBus, "STS3215"),
}
CONTROLLERS = {"simulated controller": "sim", "firmware": "fw"}
DRIVERS = (*CONTROLLERS, "sim", *SERVOS)


def mounting(zero_rad: float = -0.7, **changes: Any) -> Mounting:
    """Zeros so that the whole range lies within one turn, each another one."""
    zero = zero_rad + 0.02 * np.arange(12)
    return Mounting(**{"zero_rad": zero, "sign": np.ones(12), "ratio": np.ones(12), **changes})


def motor_map(mounted: Mounting | None = None) -> MotorMap:
    return MotorMap(NAMES, MOTORS, GEARS, mounted or mounting())


def tendon_hand(
    joint_rad: np.ndarray = START, limits: JointLimits | None = None, **physics: float
) -> TendonHand:
    return TendonHand(GEARS, limits or hand_limits(), joint_rad, TendonPhysics(**physics))


@contextmanager
def servo_bench(
    kind: str, mounted: Mounting | None = None, hand: TendonHand | None = None
) -> Iterator[ServoBench]:
    """Servos of a maker behind a pseudo terminal."""
    with SERVOS[kind][0](hand or tendon_hand(), mounted or mounting(), NUMBERS) as bench:
        yield bench


def servo_bus(kind: str, port: str, numbers: tuple[int, ...] = NUMBERS, **changes: Any) -> Any:
    model = changes.pop("model", SERVOS[kind][2])
    return SERVOS[kind][1](MOTORS, numbers, model, port, 1_000_000, **changes)


class Rig:
    """A bus, and the ways of the world with it; steps of goals that a servo takes at once."""

    def __init__(self, bus: MotorBus, kind: str) -> None:
        self.bus, self.kind = bus, kind

    @property
    def watches(self) -> bool:
        """Whether the motors can notice that the host is silent."""
        return self.kind != "feetech"

    def stay(self, cycles: int) -> None:
        """Tell the axes to be where they are, again and again."""
        for _ in range(cycles):
            self.bus.write_goals(self.bus.read_state().position_rad)

    def go(self, goal: np.ndarray, patience_s: float = 3.0) -> np.ndarray:
        """Lead the axes to a goal in steps; where they then are."""
        start = self.bus.read_state().position_rad
        for share in np.linspace(0, 1, 20):
            self.bus.write_goals(start + share * (goal - start))
            self.bus.read_state()
        deadline = time.monotonic() + patience_s
        while time.monotonic() < deadline:
            position = self.bus.read_state().position_rad
            if np.abs(position - goal).max() < 0.005:
                break
            time.sleep(0.002)
        return position


@contextmanager
def rig(kind: str, mishaps: tuple[Mishap, ...] = ()) -> Iterator[Rig]:
    """A rig of one of `DRIVERS`, its bus closed."""
    if kind == "sim":
        yield Rig(SimBus(MOTORS, tendon_hand(), mounting()), kind)
    elif kind in SERVOS:
        with servo_bench(kind) as bench:
            made = Rig(servo_bus(kind, bench.port), kind)
            made.bench = bench  # type: ignore[attr-defined]
            yield made
            made.bus.close()
    else:
        start = SIMULATED_PORTS[CONTROLLERS[kind]]
        with start(hand_limits(), START, clock_rate=4.0, mishaps=mishaps) as device:
            bus = ControllerBus(hand_limits(), lambda: closing(open_port(device.port)))
            made = Rig(bus, kind)
            made.pid = device.pid  # type: ignore[attr-defined]
            yield made
            bus.close()


def unplug(made: Rig) -> None:
    """The adapter goes away while the program runs."""
    if made.kind in SERVOS:
        made.bench.unplug()  # type: ignore[attr-defined]
    else:
        os.kill(made.pid, signal.SIGKILL)  # type: ignore[attr-defined]
