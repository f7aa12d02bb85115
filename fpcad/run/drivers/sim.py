"""A servo bus without hardware: simulated motors and tendons in this process."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

from fpcad.run.bus import BusState, Identity, checked_goals
from fpcad.run.errors import PortMissing, WatchdogTripped
from fpcad.run.link import Clock
from fpcad.run.motor_map import Mounting
from fpcad.run.sim.tendon_hand import TendonHand

Array = NDArray[np.float64]

TORQUE_PER_MA = 2.94 / 2700
"""Of the servo that it imitates [N m / mA]."""
_AMBIENT_C = 25.0


class SimBus:
    """Motors named `names` on a :class:`TendonHand`; time passes with `clock`, `rate` times real."""

    without_host = "Its simulated motors stop when they hear nothing."
    torque_per_ma = TORQUE_PER_MA
    goal_range_rad = (-np.inf, np.inf)

    def __init__(
        self,
        names: tuple[str, ...],
        hand: TendonHand,
        mounting: Mounting,
        clock: Clock = time.monotonic,
        rate: float = 1.0,
    ) -> None:
        self._rate = max(rate, 1.0)  # a host's silence is in the host's time
        self.names, self.hand, self.mounting = names, hand, mounting
        self._clock = clock
        self._open = self._on = self._tripped = False
        self._share = 1.0
        self._patience_s = np.inf
        self._goal = hand.spool_rad.copy()
        self._at_s = clock()

    def open(self) -> None:
        self._open = True
        self._at_s = self._clock()

    def identify(self) -> tuple[Identity, ...]:
        self._pass_time()
        return tuple(Identity(name, i, "simulated", "1") for i, name in enumerate(self.names, 1))

    def read_state(self) -> BusState:
        self._pass_time()
        self._require_awake()
        return BusState(
            self.mounting.to_bus(self.hand.spool_rad),
            np.abs(self.hand.torque_nm) / TORQUE_PER_MA,
            np.full(len(self.names), _AMBIENT_C),
            self._on,
            0,
        )

    def write_goals(self, goal_rad: Array) -> None:
        goal = checked_goals(self.names, goal_rad)
        self._pass_time()
        self._require_awake()
        self._goal = self.mounting.to_spool(goal)

    def torque(self, on: bool) -> None:
        self._pass_time()
        self._tripped = False
        if on and not self._on:
            self._goal = self.hand.spool_rad.copy()
        self._on = on

    def watchdog(self, timeout_s: float) -> bool:
        self._pass_time()
        self._tripped = False
        self._patience_s = timeout_s * self._rate
        return True

    def limit_torque(self, share: float) -> None:
        self._pass_time()
        self._share = share

    def close(self) -> None:
        self._open = False

    def _pass_time(self) -> None:
        if not self._open:
            raise PortMissing("the simulated bus is closed")
        now = self._clock()
        gap, self._at_s = now - self._at_s, now
        self._advance(min(gap, self._patience_s))
        if gap > self._patience_s and self._on:
            self._tripped = True
            self._goal = self.hand.spool_rad.copy()
            self._advance(gap - self._patience_s)

    def _advance(self, seconds: float) -> None:
        n = len(self.names)
        if seconds > 0:
            self.hand.step(self._goal, np.full(n, self._on), np.full(n, self._share), seconds)

    def _require_awake(self) -> None:
        if self._tripped:
            raise WatchdogTripped(
                f"the motors heard nothing for {self._patience_s:g} s and stopped by themselves; "
                "start anew"
            )
