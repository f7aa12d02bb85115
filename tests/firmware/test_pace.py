"""How much work a tick, a knot and a stop are, in instructions: the same on every machine."""

import re
import struct
import subprocess
import time
from contextlib import closing

import pytest

from fpcad.run.port import open_port
from tests.firmware.core import made
from tests.firmware.targets import image, qemu

INSTRUCTIONS_A_COUNT = 40
"""QEMU takes a nanosecond for each instruction; the counter runs at 25 MHz."""
RELOAD = 2_500_000
PIECES = ("a knot", "a tick", "the path's place", "an emergency stop")
# Instructions a second, at the clocks of the boards that docs/firmware.md names. A Cortex-M0+ takes
# about 1.3 cycles for one, a Cortex-M4 about 1.2.
BUDGETS = {"mps2_an385_timing.elf": 100e6 / 1.2, "mps2_an385_m0.elf": 125e6 / 1.3}


def instructions(name: str) -> dict[str, list[int]]:
    """Instructions of each piece of work, all its times."""
    elf = image("mps2_an385", name)
    with qemu(elf, "-icount", "shift=0,sleep=off") as port, closing(open_port(port)) as line:
        data, deadline = b"", time.monotonic() + 60
        while b"\xff" not in data[::5] and time.monotonic() < deadline:
            if not data:
                line.write(b"\1")
            data += line.read()
    found, began = {piece: [] for piece in PIECES}, 0
    for number, counter in struct.iter_unpack("<BI", data[: len(data) // 5 * 5]):
        if number % 2 and number < 9:
            began = counter
        elif number < 9:
            took = (began - counter) % RELOAD * INSTRUCTIONS_A_COUNT
            found[PIECES[number // 2 - 1]].append(took)
    return found


@pytest.mark.parametrize("name", BUDGETS)
def test_a_32_bit_controller_has_time_for_a_thousand_ticks_a_second(name):
    work = instructions(name)
    second = 1000 * max(work["a tick"]) + 40 * max(work["a knot"])
    for piece, counts in work.items():
        print(
            f"{name}: {piece}: {sum(counts) / len(counts):.0f} instructions, {max(counts)} at most"
        )
    print(f"{name}: 1000 ticks and 40 knots a second: {second / 1e6:.1f} million instructions")
    assert second < 0.8 * BUDGETS[name]
    assert max(work["an emergency stop"]) < 20_000


def test_an_avr_is_too_slow_for_a_hand_and_says_how_much():
    elf = image("avr", "avr_timing.elf")
    timer = made("build/time_avr") / "time_avr"
    done = subprocess.run([timer, elf], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    print(done.stdout)
    tick, stop = (longest_ms(done.stdout, piece) for piece in ("a tick", "torque off"))
    assert tick > 4.0  # so that nobody believes in 250 Hz
    assert stop < 1.0


def longest_ms(text: str, piece: str) -> float:
    found = re.search(rf"{piece}: .*, ([\d.]+) ms at most", text)
    assert found is not None, text
    return float(found[1])
