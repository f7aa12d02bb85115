"""The simulated controller's process: reads its set-up from stdin, names its port on stdout.

Stdin stays open as a lifeline: when it ends, or when the port is closed by the other side, the
process lets its joints come to rest by the controller's own rules, then ends.
"""

from __future__ import annotations

import json
import os
import pty
import secrets
import select
import sys
import time
import tty
from pathlib import Path

import numpy as np

from fpcad.run.knots import BUFFER_KNOTS
from fpcad.run.sim.controller import TICK_HZ, Controller, ControllerSetup
from fpcad.run.sim.plant import Plant
from fpcad.run.sim.spawn import Mishap, limits_from_json

_LONGEST_GAP_S = 0.05
"""When this process was starved for longer, the controller's clock slips instead of jumping: a
real controller's clock would not have seen a gap between a frame's arrival and its reading."""
_LAST_MOTION_S = 3.0
"""Longest life after the host is gone."""


class Terminal:
    """The controller's side of a pseudo terminal."""

    def __init__(self) -> None:
        self._master, self._slave = pty.openpty()
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        self.name = os.ttyname(self._slave)
        self._connected = False
        self.open = True

    def fileno(self) -> int:
        """What select waits for."""
        return self._master

    def read(self) -> bytes:
        """What the host wrote; `open` turns false when the host has closed the port."""
        try:
            data = os.read(self._master, 4096)
        except BlockingIOError:
            return b""
        except OSError:  # how Linux says that nobody holds the other side any more
            self.open = False
            return b""
        if data and not self._connected:
            # From here on only the host holds the other side, so its end is noticed.
            os.close(self._slave)
            self._connected = True
        return data

    def write(self, data: bytes) -> None:
        """Send; what a host that does not read leaves no room for is lost, as on a wire."""
        try:
            os.write(self._master, data)
        except BlockingIOError:
            return
        except OSError:
            self.open = False


class Recorder:
    """What the joints did in every tick, for tests and for plots."""

    def __init__(self, path: Path | None) -> None:
        self._path = path
        self._rows: list[np.ndarray] = []

    def add(self, controller: Controller) -> None:
        """Note the present tick."""
        if self._path is not None:
            head = [controller.time_us / 1e6, controller.state, controller.follower.rate]
            self._rows.append(
                np.concatenate([head, controller.follower.command, controller.plant.position])
            )

    def save(self) -> None:
        """Write `rows` (ticks, 3 + 2 n): time [s], state, path rate, command and position [rad]."""
        if self._path is None:
            return
        temporary = self._path.with_name(self._path.name + ".partial")
        with temporary.open("wb") as file:
            np.savez(file, rows=np.array(self._rows))
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, self._path)


class Device:
    """A controller on a terminal, with the mishaps that it was told to have."""

    def __init__(self, data: dict, terminal: Terminal) -> None:
        self.terminal = terminal
        self.recorder = Recorder(Path(data["record"]) if data["record"] else None)
        self._rate = float(data["clock_rate"])
        self._limits = limits_from_json(data)
        self._mishaps = [Mishap(**mishap) for mishap in data["mishaps"]]
        self._mute = self._noisy = False
        self.controller = self._boot(Plant(np.array(data["start_rad"])))
        self._let_mishaps_happen()

    def _boot(self, plant: Plant) -> Controller:
        # Silence and buffer are in the host's time, whatever the pace of the controller's.
        setup = ControllerSetup(
            self._limits,
            secrets.randbits(32),
            buffer_knots=round(BUFFER_KNOTS * max(self._rate, 1)),
            silence_us=round(500_000 * max(self._rate, 1)),
        )
        return Controller(setup, plant)

    def exchange(self) -> None:
        """Take what the host sent and send the answers."""
        data = self.terminal.read()
        if self._mute:
            return
        self.controller.receive(data)
        output = self.controller.take_output()
        if output:
            self.terminal.write(secrets.token_bytes(len(output)) if self._noisy else output)

    def tick(self) -> None:
        """Advance by one period of the controller."""
        self.controller.tick()
        self.recorder.add(self.controller)
        self._let_mishaps_happen()

    def _let_mishaps_happen(self) -> None:
        due = [m for m in self._mishaps if m.at_s <= self.controller.time_us / 1e6]
        for mishap in due:
            self._mishaps.remove(mishap)
            self._happen(mishap)

    def _happen(self, mishap: Mishap) -> None:
        if mishap.kind == "silence":
            self._mute = True
        elif mishap.kind == "garbage":
            self._noisy = True
        elif mishap.kind == "jam":
            self.controller.plant.jam(mishap.joint)
        elif mishap.kind == "reset":
            self.controller = self._boot(self.controller.plant)
        else:
            raise ValueError(f"unknown mishap {mishap.kind}")


def serve(device: Device, clock_rate: float) -> None:
    """Run the controller in real time until the host is gone and the joints stand."""
    period = 1 / (TICK_HZ * clock_rate)
    due = time.monotonic()
    gone_at: float | None = None
    while gone_at is None or (
        device.controller.moving and time.monotonic() - gone_at < _LAST_MOTION_S
    ):
        if gone_at is None:
            gone_at = _wait(device, max(due - time.monotonic(), 0.0))
        else:
            time.sleep(max(due - time.monotonic(), 0.0))
        device.exchange()
        now = time.monotonic()
        if now - due > _LONGEST_GAP_S:
            due = now
        while due <= now:
            device.tick()
            due += period


def _wait(device: Device, timeout_s: float) -> float | None:
    """Wait for the host's bytes or for time to pass; the time when the host was found gone."""
    lifeline = sys.stdin.fileno()
    ready, _, _ = select.select([device.terminal, lifeline], [], [], timeout_s)
    cut = lifeline in ready and not os.read(lifeline, 4096)
    return time.monotonic() if cut or not device.terminal.open else None


def main() -> None:
    """Entry point of the process."""
    data = json.loads(os.fdopen(os.dup(sys.stdin.fileno()), "rb", buffering=0).readline())
    terminal = Terminal()
    device = Device(data, terminal)
    print(terminal.name, flush=True)
    serve(device, float(data["clock_rate"]))
    device.recorder.save()


if __name__ == "__main__":
    main()
