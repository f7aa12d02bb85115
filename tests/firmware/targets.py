"""Microcontrollers without a board: QEMU's Cortex-M3 and simavr's ATmega1284P."""

from __future__ import annotations

import re
import select
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest

from fpcad.run.firmware_setup import FirmwareSetup, setup_source
from fpcad.run.limits import JointLimits
from tests.firmware.core import FIRMWARE, made
from tests.run.fixtures import hand_limits, swing

TOOLS = {
    "mps2_an385": ("arm-none-eabi-gcc", "qemu-system-arm"),
    "avr": ("avr-gcc",),
}
# Simulated machines share this one with the host, so they wait longer for it than a board would.
PATIENT = {"silence_us": 2_000_000}
SETUPS = {
    "mps2_an385": {"tick_hz": 1000, "buffer_knots": 64, "build": b"fpcad-fw arm", **PATIENT},
    "avr": {"tick_hz": 50, "buffer_knots": 48, "build": b"fpcad-fw avr", **PATIENT},
}
BOOT_NONCE = 7


@dataclass(frozen=True)
class BuiltHand:
    """The hand that an image is built for, and how its simulated motors are put on."""

    folder: str
    limits: JointLimits
    start_rad: np.ndarray  # (n,)
    zero_error_rad: np.ndarray  # (n,) of the motors
    setup: dict[str, object] = field(default_factory=dict)


WHOLE = BuiltHand("build", hand_limits(), swing().position[0], np.zeros(12))


def image(target: str, name: str, hand: BuiltHand = WHOLE) -> Path:
    """An image of the firmware for a hand, that of the fixtures; skips where a tool is missing."""
    for tool in TOOLS[target]:
        if shutil.which(tool) is None:
            pytest.skip(f"needs {tool}")
    setup = FirmwareSetup(hand.limits, **{"boot_nonce": BOOT_NONCE, **SETUPS[target], **hand.setup})
    source = FIRMWARE / hand.folder / f"{target}_setup.c"
    source.parent.mkdir(exist_ok=True, parents=True)
    text = setup_source(setup, hand.start_rad.tolist(), hand.zero_error_rad.tolist())
    if not source.is_file() or source.read_text() != text:
        source.write_text(text)
    file = f"{hand.folder}/{name}"
    made(file, f"BUILD={hand.folder}", f"SETUP={hand.folder}/{source.name}")
    return FIRMWARE / file


@contextmanager
def running(target: str, name: str = "", hand: BuiltHand = WHOLE) -> Iterator[str]:
    """Name of the port at which a microcontroller that has just booted answers.

    `name`: another image than the target's usual one.
    """
    elf = image(target, name or f"{target}.elf", hand)
    if target == "avr":
        made("build/simulate_avr")
        with _process([str(FIRMWARE / "build" / "simulate_avr"), str(elf)]) as port:
            yield port
    else:
        with qemu(elf) as port:
            yield port


@contextmanager
def qemu(elf: Path, *options: str) -> Iterator[str]:
    """Name of the port of a Cortex-M3 in QEMU that has just booted."""
    machine = ["-machine", "mps2-an385", "-nographic", "-monitor", "none", "-serial", "pty"]
    with _process(["qemu-system-arm", *machine, *options, "-kernel", str(elf)]) as name:
        yield name


@contextmanager
def _process(command: list[str]) -> Iterator[str]:
    with subprocess.Popen(
        command, 0, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    ) as process:
        try:
            yield _port(process)
        finally:
            process.kill()


def _port(process: subprocess.Popen) -> str:
    assert process.stdout is not None
    while select.select([process.stdout], [], [], 10)[0]:
        line = process.stdout.readline().decode()
        if found := re.search(r"/dev/pts/\d+", line):
            return found.group()
        if not line:
            break
    raise RuntimeError("the target did not name its port")
