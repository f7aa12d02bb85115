"""Which driver a name stands for, and the servo bus of a hand."""

from __future__ import annotations

import time

import numpy as np

from fpcad.errors import SpecError
from fpcad.run.bus import ServoBus
from fpcad.run.drivers.dynamixel import DynamixelBus
from fpcad.run.drivers.feetech import FeetechBus
from fpcad.run.drivers.servo_types import ServoModel
from fpcad.run.drivers.servos import ServoRegisterBus
from fpcad.run.drivers.sim import SimBus
from fpcad.run.hand_files import HandFiles
from fpcad.run.motor_map import Array, MotorMap
from fpcad.run.servo_guard import ServoGuards
from fpcad.run.sim.tendon_hand import TendonHand
from fpcad.spec.catalogue import motor

SERVOS: dict[str, type[ServoRegisterBus]] = {"dynamixel": DynamixelBus, "feetech": FeetechBus}
DRIVERS = ("fw", "sim", *SERVOS)
"""Names that users give: the project's firmware, simulated motors, and the servo makers."""
FASTEST = 100.0
"""Rate of simulated motors at which no time is waited for."""
_GUARD_SHARE = 0.9
"""Part of the stall current that ends a run."""


def register_bus(kind: str, hand: HandFiles, port: str) -> ServoRegisterBus:
    """The servos of a hand on a port, not opened yet."""
    made, wanted = SERVOS[kind], hand.spec.motors.type
    model = next((m.name for m in made.models.values() if wanted.startswith(m.name)), None)
    if model is None:
        known = ", ".join(m.name for m in made.models.values())
        raise SpecError(
            f"motors.type {wanted} is no servo of the driver {kind}, which knows {known}"
        )
    rate = hand.spec.motors.wiring.baud_rate
    return made(hand.motors, hand.numbers, model, port, rate)


def servo_of(hand: HandFiles) -> ServoModel:
    """What a hand's motors are, whatever drives them: their torque for their current."""
    wanted = hand.spec.motors.type
    known = [model for bus in SERVOS.values() for model in bus.models.values()]
    model = next((model for model in known if wanted.startswith(model.name)), None)
    if model is None:
        names = ", ".join(model.name for model in known)
        raise SpecError(f"motors.type {wanted}: its torque is not known; known are {names}")
    return model


class Pace:
    """How time passes on a bus; only that of simulated motors can be hurried.

    At the highest rate nobody waits for it: it passes when somebody sleeps, as fast as it can.
    """

    def __init__(self, rate: float = 1.0) -> None:
        self.rate = rate
        self._unhurried_s: float | None = 0.0 if rate >= FASTEST else None

    def clock(self) -> float:
        """The bus's time [s]."""
        return time.monotonic() * self.rate if self._unhurried_s is None else self._unhurried_s

    def sleep(self, seconds: float) -> None:
        """Let the bus's time pass [s]."""
        if self._unhurried_s is None:
            time.sleep(seconds / self.rate)
        else:
            self._unhurried_s += seconds


def simulated_bus(hand: HandFiles, joint_rad: Array, pace: Pace) -> SimBus:
    """Simulated motors whose joints are at `joint_rad` (n,), mounted as :func:`simulated_map` says."""
    plant = TendonHand(hand.transmission, hand.limits, joint_rad)
    return SimBus(hand.motors, plant, simulated_map(hand).mounting, pace.clock, pace.rate)


def simulated_map(hand: HandFiles) -> MotorMap:
    """The truth about simulated motors: wired as designed, zeros at 0."""
    return hand.motor_map()


def guards_of(hand: HandFiles, bus: ServoBus) -> ServoGuards:
    """Bounds that end a run, from the catalogue's row of the motors."""
    stall_nm = motor(hand.spec.motors.type).stall_torque_nm
    return ServoGuards(current_ma=float(np.floor(_GUARD_SHARE * stall_nm / bus.torque_per_ma)))
