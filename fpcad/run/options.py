"""How a trajectory is run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from fpcad.run.report import Progress


@dataclass(frozen=True)
class RunOptions:
    """How a trajectory is run."""

    speed: float = 1.0
    """Factor of the trajectory's speed, at most 1."""
    loops: int = 1
    """How often the trajectory is run."""
    move_to_start: bool = False
    """Go to the first posture slowly and straight, however far it is. Without it, a distance of
    more than 2 degrees is an error."""
    clear: bool = False
    """Unlatch a controller that is in HOLD, FAULT or ESTOP."""
    log: Path | None = None
    """Table of all telemetry, Parquet or CSV by its ending; written also when the run fails."""
    on_progress: Callable[[Progress], None] | None = None
    """Called for each telemetry sample, about 50 times a second."""
    motor_names: tuple[str, ...] = ()
    """For the table."""
    tool_in: Callable[[], bool] | None = None
    """Asked again and again at the start posture, with the hand open, until the tool is in it; only
    then the grip closes and the motion begins. Without it nobody is waited for."""
