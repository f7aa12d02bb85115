"""One call from a trajectory file to joints that have followed it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fpcad.run.driver import Driver, Sample, Watch
from fpcad.run.errors import PortMissing, StartTooFar
from fpcad.run.firmware import FirmwareDriver
from fpcad.run.interrupt import counted_interrupts
from fpcad.run.knots import Array, approach, from_wire, to_wire
from fpcad.run.limits import JointLimits
from fpcad.run.port import Transport, open_port
from fpcad.run.quintic import Knots
from fpcad.run.report import Progress, RunReport, TelemetryLog, TrackingError
from fpcad.run.session import HANDSHAKE_S
from fpcad.run.sim.spawn import firmware_process, simulated_controller
from fpcad.run.trajectory import in_order, read_trajectory, repeated, require_within, slowed

SIMULATED_PORTS = {"sim": simulated_controller, "fw": firmware_process}
"""Controllers that a run starts by itself: the simulator, and the firmware with simulated motors."""
START_DISTANCE_RAD = float(np.radians(2.0))
"""Way to the start that a run takes unasked."""
OUTSIDE_RAD = float(np.radians(0.25))
"""How far beyond its limit a resting joint may be seen: encoders have steps of 0.09 degrees."""
_APPROACH_SHARE = 0.2
"""Part of the limits that the way to the start may use."""


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
    knots = _planned(trajectory_file, limits, speed, loops)
    wire = to_wire(knots)
    return DryRun(float(knots.time_s[-1]), len(wire.messages), wire.error_rad)


def run_trajectory(
    trajectory_file: Path,
    limits: JointLimits,
    port: str,
    *,
    speed: float = 1.0,
    loops: int = 1,
    move_to_start: bool = False,
    clear: bool = False,
    log: Path | None = None,
    on_progress: Callable[[Progress], None] | None = None,
    patience_s: float = HANDSHAKE_S,
) -> RunReport:
    """Stream a trajectory to the controller at `port` and wait until it has been followed.

    Ctrl-C once slows down along the path and holds; twice turns torque off.

    Args:
        trajectory_file: JSON file of a build.
        limits: the hand's limits, in the controller's joint order (`read_limits`).
        port: a serial port; `sim` starts a simulated controller, `fw` the firmware itself with
            simulated motors, `sim:20` or `fw:20` the same 20 times as fast as real time.
        speed: factor of the trajectory's speed, at most 1.
        loops: how often the trajectory is run.
        move_to_start: go to the first posture slowly and straight, however far it is. Without
            it, a distance of more than 2 degrees is an error.
        clear: unlatch a controller that is in HOLD, FAULT or ESTOP.
        log: CSV file for all telemetry; written also when the run fails.
        on_progress: called for each telemetry sample, about 50 times a second.
        patience_s: how long to wait for a controller's first answer [s].

    Raises:
        RunError: one subclass, with its own exit code, for each cause (docs/link.md).
    """
    knots = _planned(trajectory_file, limits, speed, loops)
    posture = _nearest_to_straight(limits) if move_to_start else knots.position[0]
    with _transport(port, limits, posture) as transport:
        driver = FirmwareDriver(transport, limits, patience_s=patience_s)
        present = driver.ready(clear=clear)
        path = _from_present(present, knots, limits, move_to_start)
        return follow(driver, path, limits.names, log, on_progress)


def follow(
    driver: Driver,
    knots: Knots,
    joint_names: tuple[str, ...],
    log: Path | None = None,
    on_progress: Callable[[Progress], None] | None = None,
) -> RunReport:
    """Let a driver that is ready follow the knots, and sum up how well it did."""
    error = TrackingError(len(joint_names))
    total_s = float(knots.time_s[-1])

    with TelemetryLog(log, joint_names) as table, counted_interrupts() as stops:

        def note(sample: Sample) -> None:
            largest = error.add(sample)
            table.add(sample)
            if on_progress is not None:
                on_progress(_progress(sample, total_s, largest))

        played = driver.play(knots, Watch(note, stops))
    return RunReport(
        controller=driver.identity,
        seconds=total_s,
        knots=played.knots,
        resends=played.resends,
        bad_frames=played.bad_frames,
        samples=error.samples,
        joint_names=joint_names,
        max_error_rad=tuple(error.max_rad.tolist()),
        rms_error_rad=tuple(error.rms_rad.tolist()),
        max_error_all_rad=float(error.max_rad.max()),
        rms_error_all_rad=float(np.sqrt(np.mean(error.rms_rad**2))),
        wire_error_rad=played.wire_error_rad,
        final_state=played.final_state,
    )


def _planned(trajectory_file: Path, limits: JointLimits, speed: float, loops: int) -> Knots:
    once = slowed(in_order(read_trajectory(trajectory_file), limits), speed)
    # What counts is what is sent: the controller will check the same segments again.
    require_within(from_wire(to_wire(once).messages), limits)
    return repeated(once, loops)


def _from_present(present: Sample, knots: Knots, limits: JointLimits, far: bool) -> Knots:
    distance = np.abs(present.command_rad - knots.position[0])
    worst = int(distance.argmax())
    if distance[worst] > START_DISTANCE_RAD and not far:
        raise StartTooFar(
            f"{limits.names[worst]} is {np.degrees(distance[worst]):.1f} degrees from where the "
            "trajectory starts (2 are allowed); bring the hand there, or ask for a move to start"
        )
    return approach(_resting_within(present, limits), knots, limits, _APPROACH_SHARE)


def _resting_within(present: Sample, limits: JointLimits) -> Array:
    """Where the path may begin: what the encoders say, or the limit that it lies just beyond."""
    nearest = np.minimum(np.maximum(present.command_rad, limits.lower_rad), limits.upper_rad)
    beyond = np.abs(present.command_rad - nearest)
    worst = int(beyond.argmax())
    if beyond[worst] > OUTSIDE_RAD:
        raise StartTooFar(
            f"{limits.names[worst]} rests {np.degrees(beyond[worst]):.1f} degrees beyond its limit; "
            "bring it back by hand"
        )
    return nearest


def _nearest_to_straight(limits: JointLimits) -> Array:
    return np.minimum(np.maximum(0.0, limits.lower_rad), limits.upper_rad)


def _progress(sample: Sample, total_s: float, largest: float) -> Progress:
    return Progress(
        sample.path_s, total_s, sample.knots_sent, sample.resends, sample.state, largest
    )


@contextmanager
def _transport(port: str, limits: JointLimits, posture: Array) -> Iterator[Transport]:
    """The line to a real controller, or to a simulated one whose joints rest at `posture`."""
    start = SIMULATED_PORTS.get(port.partition(":")[0])
    if start is None:
        with closing(open_port(port)) as transport:
            yield transport
        return
    rate = _clock_rate(port)
    with start(limits, posture, clock_rate=rate) as device:  # noqa: SIM117
        with closing(open_port(device.port)) as transport:
            yield transport


def _clock_rate(port: str) -> float:
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
