"""Long tests of the link against the firmware's core, in virtual time: `make soak`."""

from __future__ import annotations

import gc
import random
import resource
import subprocess
from collections import Counter
from dataclasses import dataclass

import numpy as np
import pytest

from fpcad.run.driver import Watch
from fpcad.run.errors import ControllerSilent, LinkLost
from fpcad.run.firmware import FirmwareDriver
from fpcad.run.knots import from_wire, to_wire
from fpcad.run.messages import State
from fpcad.run.quintic import evaluate
from fpcad.run.trajectory import repeated
from tests.firmware.byte_log import Recorded, kept_on_failure
from tests.firmware.core import core_controller, made
from tests.firmware.cuts import DIRECTIONS, Cuts, bytes_of_a_session
from tests.run.fixtures import hand_limits, swing
from tests.run.streaming import KNOTS
from tests.run.virtual import Damage, VirtualLine, bit_flips, lost_bytes, lost_frames

FRAMES = {"bit_flips": 1_000_000, "lost_bytes": 300_000, "mangled": 300_000}
"""Frames that pass in both directions, by the damage done to them."""
TICK_US = 4_000
WANTED = np.rint(
    evaluate(
        from_wire(to_wire(KNOTS).messages), np.arange(0, 4_000_001, TICK_US) / 1e6
    ).position * 1e6
).astype(int)  # fmt: skip


class FaithfulTick:
    """Every command at full pace is the one that the knots say, to a count."""

    def __init__(self) -> None:
        self.ticks = 0

    def __call__(self, line: VirtualLine) -> None:
        view = line.device.look()
        if view.state == State.RUNNING and view.rate == 1:
            self.ticks += 1
            assert view.path_us % TICK_US == 0
            error = np.abs(np.array(view.command) - WANTED[view.path_us // TICK_US]).max()
            with kept_on_failure(line.device, "damaged_run"):
                assert error <= 1, f"{error} counts off at {view.path_us} us"


def mangled(rate: float, seed: int) -> Damage:
    """Inserts, drops, doubles and swaps bytes."""
    chance = random.Random(seed)

    def damage(data: bytes) -> bytes:
        out = bytearray()
        for byte in data:
            fate = chance.random() / rate
            if fate < 1:
                out += (b"", bytes([byte, byte]), bytes([byte, chance.randrange(256)]))[
                    chance.randrange(3)
                ]
                if chance.random() < 0.3:
                    out[-2:] = out[-2:][::-1]
            else:
                out.append(byte)
        return bytes(out)

    return damage


@dataclass
class Tally:
    frames: int = 0
    runs: int = 0
    complete: int = 0
    resends: int = 0


def damaged_run(damage, rate: float, seed: int, tally: Tally) -> str:
    """One run of four seconds; how it ended."""
    line = VirtualLine(
        Recorded(core_controller()),
        to_device=damage(rate, seed),
        to_host=damage(rate, seed + 10**6),
        baud_rate=115_200,
        on_tick=(faithful := FaithfulTick()),
    )
    tally.runs += 1
    end = "complete"
    try:
        driver = FirmwareDriver(line, hand_limits(), line.clock)
        driver.ready(clear=False)
        played = driver.play(KNOTS, Watch(lambda _sample: None, lambda: 0))
        assert played.final_state == "READY" and faithful.ticks == 999
        tally.complete += 1
        tally.resends += played.resends
    except (LinkLost, ControllerSilent) as error:
        end = type(error).__name__
        line.let_pass(1.5)
        with kept_on_failure(line.device, "damaged_run"):
            assert line.device.follower.rate == 0
    heard = int(line.device.time_us / 20_000 * 1.2)  # telemetry and health
    tally.frames += len(line.log) + heard
    return end


@pytest.mark.parametrize("damage", [bit_flips, lost_bytes, mangled], ids=lambda d: d.__name__)
def test_a_million_damaged_frames(damage):
    rates = (1e-5, 1e-4, 1e-3, 3e-3, 1e-2)
    for rate in rates:
        tally, ends, seed = Tally(), Counter(), 0
        while tally.frames < FRAMES[damage.__name__] / len(rates):
            ends[damaged_run(damage, rate, seed, tally)] += 1
            seed += 1
        print(f"\n{damage.__name__} {rate:g} a byte, seeds 0..{seed - 1}: {tally}, {dict(ends)}")
        assert rate > 1e-3 or ends["complete"] == tally.runs


@pytest.mark.parametrize("rate", [0.01, 0.03])
def test_lost_doubled_and_late_frames(rate):
    tally, ends = Tally(), Counter()
    for seed in range(100):
        ends[damaged_run(lost_frames, rate, seed, tally)] += 1
    print(f"\nframes lost, doubled, late {rate:g} each: {tally}, {dict(ends)}")
    assert ends["complete"] == tally.runs


@pytest.mark.parametrize("loud", [True, False], ids=["port error", "silence"])
@pytest.mark.parametrize("direction", DIRECTIONS)
def test_a_cut_after_each_byte_of_a_session(direction, loud):
    cuts = Cuts()
    for cut in range(bytes_of_a_session(direction) - 1):
        cuts.add(cut, direction, loud)
    print(f"\ncut {direction} after each byte, {'port error' if loud else 'silence'}: {cuts}")


class SkewedLine(VirtualLine):
    """The host's clock runs faster or slower than the controller's."""

    skew: float = 0.0

    def clock(self) -> float:
        return self.now_s * (1 + self.skew)


@pytest.mark.parametrize("skew_ppm", [-200, 0, 200])
def test_clocks_that_differ_over_ten_minutes(skew_ppm):
    motion = repeated(swing(4.0, 101), 150)  # 25 knots a second
    line = SkewedLine(core_controller(), baud_rate=115_200)
    line.skew = skew_ppm * 1e-6
    errors, memory = [], []
    driver = FirmwareDriver(line, hand_limits(), line.clock)
    driver.ready(clear=False)

    def note(sample):
        if sample.state == "RUNNING" and round(sample.device_s * 50) % 500 == 0:
            clock = stream_clock()
            errors.append((clock.device_us(line.clock()) - line.device.time_us) / 1e3)
            line.log.clear()
            gc.collect()
            memory.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)

    def stream_clock():
        streams = [o for o in gc.get_objects() if type(o).__name__ == "DeviceClock"]
        return streams[-1]

    played = driver.play(motion, Watch(note, lambda: 0))
    growth, half = memory[-1] - memory[2], len(errors) // 2
    drift = abs(np.mean(errors[half:]) - np.mean(errors[:half]))
    print(
        f"\n{skew_ppm:+d} ppm, {motion.time_s[-1]:.0f} s, {played.knots} knots: "
        f"clock {np.mean(errors):.3f} ms behind (the line's delay), drift {drift:.3f} ms, "
        f"memory {growth:+d} kB, ended {played.final_state}"
    )
    assert played.final_state == "READY" and drift <= 1.0
    assert growth < 4096


@pytest.mark.parametrize("seed", range(10))
def test_ten_million_bytes_of_anything(seed):
    """With sanitizers of addresses and of undefined behaviour."""
    fuzz = made("fuzz") / "fuzz"
    done = subprocess.run([fuzz, "10000000", str(seed)], capture_output=True, text=True)
    print(f"\nseed {seed}: {done.stdout.strip()}")
    assert done.returncode == 0, done.stderr
