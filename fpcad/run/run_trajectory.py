"""One call from a trajectory file to joints that have followed it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fpcad.run.bus import ServoBus
from fpcad.run.driver import Driver, Played, Sample, Watch
from fpcad.run.errors import PortMissing
from fpcad.run.firmware import FirmwareDriver
from fpcad.run.interrupt import counted_interrupts
from fpcad.run.knots import to_wire
from fpcad.run.limits import JointLimits
from fpcad.run.link import Clock
from fpcad.run.motor_map import MotorMap
from fpcad.run.options import RunOptions
from fpcad.run.plan import closed, from_present, planned, start_of
from fpcad.run.port import Transport, open_port
from fpcad.run.quintic import Knots, preload_at
from fpcad.run.report import Progress, RunReport, TrackingError
from fpcad.run.run_log import RunLog
from fpcad.run.servo_driver import ServoDriver
from fpcad.run.servo_guard import ServoGuards
from fpcad.run.session import HANDSHAKE_S
from fpcad.run.sim.spawn import Mishap, firmware_process, simulated_controller

Array = NDArray[np.float64]

SIMULATED_PORTS = {"sim": simulated_controller, "fw": firmware_process}
"""Controllers that a run starts by itself: the simulator, and the firmware with simulated motors."""


@dataclass(frozen=True)
class DryRun:
    """What would be sent, without a port."""

    seconds: float
    knots: int
    wire_error_rad: float
    """Largest distance between the motion in the file and the one that would be sent [rad]."""


def dry_run(
    trajectory_file: Path, limits: JointLimits, *, speed: float = 1.0, loops: int = 1
) -> DryRun:
    """Check a trajectory against the limits and the wire; raises as :func:`run_trajectory`."""
    knots = planned(trajectory_file, limits, speed, loops)
    wire = to_wire(knots)
    return DryRun(float(knots.time_s[-1]), len(wire.messages), wire.error_rad)


def run_trajectory(
    trajectory_file: Path,
    limits: JointLimits,
    port: str,
    *,
    patience_s: float = HANDSHAKE_S,
    zeros_rad: Array | None = None,
    **options: object,
) -> RunReport:
    """Stream a trajectory to the controller at `port` and wait until it has been followed.

    Ctrl-C once slows down along the path and holds; twice turns torque off.

    Args:
        trajectory_file: JSON file of a build.
        limits: the hand's limits, in the controller's joint order (`read_limits`).
        port: a serial port; `sim` starts a simulated controller, `fw` the firmware itself with
            simulated motors, `sim:20` or `fw:20` the same 20 times as fast as real time.
        patience_s: how long to wait for a controller's first answer [s].
        zeros_rad: the motors' zeros (n,) as kept, for a controller that does not know them.
        options: those of :class:`RunOptions`.

    Raises:
        RunError: one subclass, with its own exit code, for each cause (docs/link.md).
    """
    wanted = RunOptions(**options)  # type: ignore[arg-type]
    knots = planned(trajectory_file, limits, wanted.speed, wanted.loops)
    posture = _nearest_to_straight(limits) if wanted.move_to_start else knots.position[0]
    with controller_line(port, limits, posture) as transport:
        driver = FirmwareDriver(transport, limits, patience_s=patience_s, zeros_rad=zeros_rad)
        return perform(driver, knots, limits, wanted)


def run_on_servos(
    trajectory_file: Path,
    limits: JointLimits,
    bus: ServoBus,
    motors: MotorMap,
    guards: ServoGuards,
    options: RunOptions,
    clock: Clock = time.monotonic,
    sleep: Callable[[float], None] = time.sleep,
) -> RunReport:
    """The same with the motors of a servo bus, which this opens and closes."""
    knots = planned(trajectory_file, limits, options.speed, options.loops)
    with closing(bus):
        bus.open()
        driver = ServoDriver(bus, motors, limits, guards, clock, sleep)
        return perform(driver, knots, limits, options)


def perform(driver: Driver, knots: Knots, limits: JointLimits, options: RunOptions) -> RunReport:
    """From where the hand is to the end of the knots: way to the start, tool, grip, motion."""
    present = driver.ready(clear=options.clear)
    preload = np.zeros(len(limits.names))
    if present.preload_rad is not None:
        preload = present.preload_rad
    motion = closed(knots, preload)
    if options.tool_in is None:
        legs = [from_present(present, motion, limits, options.move_to_start)]
    else:
        opened = start_of(knots, preload)
        way = from_present(present, opened, limits, options.move_to_start)
        legs = [way, motion] if len(way.time_s) > 1 else [motion]
    return follow(
        driver,
        legs,
        limits.names,
        options.log,
        options.on_progress,
        options.tool_in,
        options.motor_names,
    )


def follow(
    driver: Driver,
    legs: list[Knots],
    joint_names: tuple[str, ...],
    log: Path | None = None,
    on_progress: Callable[[Progress], None] | None = None,
    tool_in: Callable[[], bool] | None = None,
    motor_names: tuple[str, ...] = (),
) -> RunReport:
    """Let a driver that is ready follow the legs of a motion, and sum up how well it did.

    With `tool_in`, it waits before the last leg until that is true.
    """
    error = TrackingError(len(joint_names))
    total_s = float(sum(leg.time_s[-1] for leg in legs))
    done: list[Played] = []

    with RunLog(log, joint_names, motor_names) as table, counted_interrupts() as stops:

        def note(told: Sample) -> None:
            sample = _with_preload(told, legs[len(done)])
            largest = error.add(sample)
            table.add(sample)
            if on_progress is not None:
                begun_s = float(sum(leg.time_s[-1] for leg in legs[: len(done)]))
                on_progress(_progress(sample, begun_s, total_s, largest))

        watch = Watch(note, stops)
        for leg in legs:
            if tool_in is not None and leg is legs[-1]:
                driver.wait(tool_in, watch)
            done.append(driver.play(leg, watch))
    return _report(driver, done, error, joint_names, total_s)


def _with_preload(sample: Sample, leg: Knots) -> Sample:
    """The sample with the preload of its place on the path: controllers tell theirs more seldom."""
    if leg.preload is None or sample.state != "RUNNING":
        return sample
    return replace(sample, preload_rad=preload_at(leg, np.array([sample.path_s]))[0])


def _report(
    driver: Driver,
    done: list[Played],
    error: TrackingError,
    joint_names: tuple[str, ...],
    total_s: float,
) -> RunReport:
    return RunReport(
        controller=driver.identity,
        seconds=total_s,
        knots=sum(played.knots for played in done),
        resends=done[-1].resends,
        bad_frames=done[-1].bad_frames,
        samples=error.samples,
        joint_names=joint_names,
        max_error_rad=tuple(error.max_rad.tolist()),
        rms_error_rad=tuple(error.rms_rad.tolist()),
        max_error_all_rad=float(error.max_rad.max()),
        rms_error_all_rad=float(np.sqrt(np.mean(error.rms_rad**2))),
        wire_error_rad=max(played.wire_error_rad for played in done),
        final_state=done[-1].final_state,
    )


def _progress(sample: Sample, begun_s: float, total_s: float, largest: float) -> Progress:
    return Progress(
        begun_s + sample.path_s,
        total_s,
        sample.knots_sent,
        sample.resends,
        sample.state,
        largest,
        sample,
    )


def _nearest_to_straight(limits: JointLimits) -> Array:
    return np.minimum(np.maximum(0.0, limits.lower_rad), limits.upper_rad)


@contextmanager
def controller_line(
    port: str, limits: JointLimits, posture: Array, mishaps: Sequence[Mishap] = ()
) -> Iterator[Transport]:
    """The line to a real controller, or to a simulated one whose joints rest at `posture`.

    `mishaps` happen to a simulated one.
    """
    start = SIMULATED_PORTS.get(port.partition(":")[0])
    if start is None:
        with closing(open_port(port)) as transport:
            yield transport
        return
    rate = clock_rate(port)
    started = start(limits, posture, clock_rate=rate, mishaps=mishaps)
    with started as device, closing(open_port(device.port)) as transport:
        yield transport


def clock_rate(port: str) -> float:
    """How many times as fast as real time a simulated port such as `sim:20` is."""
    name, _, text = port.partition(":")
    try:
        rate = float(text or "1")
    except ValueError:
        rate = 0.0
    if not 0.1 <= rate <= 100:
        raise PortMissing(
            f"{port}: a simulated port is `{name}`, or `{name}:RATE` with RATE 0.1 to 100"
        )
    return rate
