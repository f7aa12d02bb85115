"""Starts a controller as a process of its own behind a pseudo terminal: simulator or firmware."""

from __future__ import annotations

import json
import math
import os
import secrets
import select
import signal
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fpcad.run.errors import SimulatorError
from fpcad.run.firmware_setup import FirmwareSetup, setup_text
from fpcad.run.knots import BUFFER_KNOTS
from fpcad.run.limits import JointLimits

FIRMWARE = Path(__file__).parents[3] / "firmware_host" / "build" / "fpcad-firmware"
"""The firmware for this machine, as `make firmware` leaves it."""
_START_S = 30.0
_END_S = 4.0
_ENCODER_STEP_RAD = 2 * math.pi / 4096
"""Of the servos' magnetic encoders."""


@dataclass(frozen=True)
class Mishap:
    """Something that goes wrong in the controller at a time of its clock.

    Kinds: `silence` (neither hears nor speaks), `garbage` (sends noise), `reset` (restarts),
    `jam` (joint number `joint` is blocked). The firmware also knows `death` (a motor neither pulls
    nor answers), `stuck` (its encoder stands still), `heat` (90 degrees C), `grasp` (a person holds a joint
    still) and `slack` (a motor's tendons do not pull within 0.06 rad either way).
    """

    kind: str
    at_s: float
    joint: int = 0


@dataclass(frozen=True)
class SimulatedDevice:
    """A simulated controller that runs."""

    port: str
    pid: int


def setup_to_json(
    limits: JointLimits,
    start_rad: NDArray[np.float64],
    clock_rate: float,
    mishaps: Sequence[Mishap],
    record: Path | None,
) -> str:
    """The one line that the process is told."""
    return json.dumps(
        {
            "names": limits.names,
            "lower_rad": limits.lower_rad.tolist(),
            "upper_rad": limits.upper_rad.tolist(),
            "velocity_rad_s": limits.velocity_rad_s.tolist(),
            "acceleration_rad_s2": limits.acceleration_rad_s2.tolist(),
            "configuration": limits.configuration.hex(),
            "start_rad": np.asarray(start_rad).tolist(),
            "clock_rate": clock_rate,
            "mishaps": [asdict(mishap) for mishap in mishaps],
            "record": None if record is None else str(record),
        }
    )


def limits_from_json(data: dict[str, Any]) -> JointLimits:
    """Limits out of the line that :func:`setup_to_json` wrote."""
    return JointLimits(
        tuple(data["names"]),
        np.array(data["lower_rad"]),
        np.array(data["upper_rad"]),
        np.array(data["velocity_rad_s"]),
        np.array(data["acceleration_rad_s2"]),
        bytes.fromhex(data["configuration"]),
    )


@contextmanager
def simulated_controller(
    limits: JointLimits,
    start_rad: NDArray[np.float64],
    *,
    clock_rate: float = 1.0,
    mishaps: Sequence[Mishap] = (),
    record: Path | None = None,
) -> Iterator[SimulatedDevice]:
    """A controller set up for `limits` whose joints rest at `start_rad` (n,).

    It ends when its port is closed by the host or when this process goes away, whatever the way.
    `clock_rate` > 1 lets its time pass faster than ours. `record`: where it leaves what its joints
    did in every tick (.npz).
    """
    setup = setup_to_json(limits, start_rad, clock_rate, mishaps, record)
    command = [sys.executable, "-m", "fpcad.run.sim.process"]
    with _process(command, setup + "\n") as device:
        yield device


@contextmanager
def firmware_process(
    limits: JointLimits,
    start_rad: NDArray[np.float64],
    *,
    clock_rate: float = 1.0,
    mishaps: Sequence[Mishap] = (),
    record: Path | None = None,
    zero_error_rad: NDArray[np.float64] | None = None,
    **changes: Any,
) -> Iterator[SimulatedDevice]:
    """As :func:`simulated_controller`, but the firmware itself with simulated motors and tendons.

    `record` becomes rows of doubles (ticks, 3 + 2 n); `zero_error_rad` (n,): how far the motors'
    zeros are from the design's, for homing to find; `changes` are of :class:`FirmwareSetup`.
    """
    rate = max(clock_rate, 1)  # silence and buffer are in the host's time
    setup = FirmwareSetup(
        limits,
        **{
            "boot_nonce": secrets.randbits(31),
            "buffer_knots": round(BUFFER_KNOTS * rate),
            "silence_us": round(500_000 * rate),
            **changes,
        },
    )
    extra = [f"clock_rate {clock_rate!r}", f"encoder_step {_ENCODER_STEP_RAD!r}"]
    extra += [f"mishap {m.kind} {m.at_s!r} {m.joint}" for m in mishaps]
    if zero_error_rad is not None:
        extra.append(f"zero_error {' '.join(repr(float(x)) for x in zero_error_rad)}")
    extra += [] if record is None else [f"record {record}"]
    text = setup_text(setup, start_rad) + "\n".join([*extra, "end", ""])
    with _process([str(_firmware())], text) as device:
        yield device


def _firmware() -> Path:
    if not FIRMWARE.is_file():
        raise SimulatorError(f"{FIRMWARE} is not there: build it with `make firmware`")
    return FIRMWARE


@contextmanager
def _process(command: list[str], setup: str) -> Iterator[SimulatedDevice]:
    process = subprocess.Popen(
        command,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
        start_new_session=True,  # Ctrl-C is for the host, which then stops the joints in order
    )
    try:
        yield SimulatedDevice(_port_of(process, setup), process.pid)
    finally:
        _end(process)


def _port_of(process: subprocess.Popen[bytes], setup: str) -> str:
    assert process.stdin is not None and process.stdout is not None
    try:
        process.stdin.write(setup.encode())
        process.stdin.flush()
    except BrokenPipeError as error:
        raise SimulatorError("the simulated controller ended before it was set up") from error
    ready, _, _ = select.select([process.stdout], [], [], _START_S)
    port = process.stdout.readline().decode().strip() if ready else ""
    if not port:
        raise SimulatorError("the simulated controller did not start; its messages stand above")
    return port


def _end(process: subprocess.Popen[bytes]) -> None:
    assert process.stdin is not None and process.stdout is not None
    process.stdin.close()  # its lifeline: it stops the joints, then ends by itself
    try:
        process.wait(_END_S)
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGKILL)
        process.wait()
    process.stdout.close()
