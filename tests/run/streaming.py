"""What tests of whole runs share: a motion, a check of every tick, a driver that plays it."""

import numpy as np

from fpcad.run.driver import Watch
from fpcad.run.firmware import FirmwareDriver
from fpcad.run.framing import FrameReader
from fpcad.run.knots import from_wire, to_wire
from fpcad.run.messages import State
from fpcad.run.quintic import evaluate
from tests.run.fixtures import hand_limits, swing

KNOTS = swing(4.0, 101)
WIRE = from_wire(to_wire(KNOTS).messages)


class Faithful:
    """Checks in every tick that the command is what the knots say."""

    def __init__(self):
        self.ticks = 0

    def __call__(self, line):
        path = line.device.follower
        if line.device.state is State.RUNNING and path.rate == 1:
            self.ticks += 1
            wanted = evaluate(WIRE, np.array([path.path_us / 1e6])).position[0]
            np.testing.assert_allclose(path.command, wanted, atol=1e-6)


def run(line, knots=KNOTS, stops=lambda: 0, limits=None):
    driver = FirmwareDriver(line, limits or hand_limits(), line.clock)
    driver.ready(clear=False)
    samples = []
    played = driver.play(knots, Watch(samples.append, stops))
    return played, samples


def at(seconds, action):
    """Do something once, when the controller's clock says so."""
    done = []

    def check(line):
        if not done and line.device.time_us >= seconds * 1e6:
            done.append(True)
            action(line)

    return check


def stall_once(line, seconds):
    """A listener to samples that keeps the host busy once, a second along the path."""
    done = []

    def stall(sample):
        if sample.path_s > 1 and not done:
            done.append(True)
            line.let_pass(seconds)

    return stall


def motion_frames(line):
    frames = FrameReader().feed(b"".join(line.log))
    return [frame for frame in frames if 0x10 <= frame.kind < 0x40]
