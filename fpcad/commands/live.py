"""What people see while motors move: a bar, and a table of all joints."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol

from rich.console import Group
from rich.live import Live
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from fpcad.commands.console import console
from fpcad.run.driver import Sample

_REFRESH_HZ = 8


class Show(Protocol):
    """Takes what is new: how far, of how much, a note, and the joints where there are some."""

    def __call__(self, done: float, total: float, note: str, sample: Sample | None) -> None: ...


@contextmanager
def live_joints(title: str, names: tuple[str, ...]) -> Iterator[Show]:
    """A progress bar with the joints below it; plain lines where nobody looks."""
    bar = Progress(
        TextColumn("{task.description:<10}"),
        BarColumn(32),
        TextColumn("{task.completed:.1f}/{task.total:.1f}"),
        TimeRemainingColumn(),
        TextColumn("[dim]{task.fields[note]}"),
        console=console,
    )
    task = bar.add_task(title, total=1.0, note="connecting")
    with Live(Group(bar), console=console, refresh_per_second=_REFRESH_HZ) as live:

        def show(done: float, total: float, note: str, sample: Sample | None) -> None:
            bar.update(task, completed=done, total=total, note=note)
            if sample is not None and console.is_terminal:
                live.update(Group(bar, joint_table(names, sample)))

        yield show
    if not console.is_interactive:
        console.print()


def joint_table(names: tuple[str, ...], sample: Sample) -> Table:
    """All joints at one instant, in degrees."""
    table = Table(box=None, padding=(0, 1))
    for heading in ("joint", "goal", "is", "error", "motor mA", "motor C"):
        table.add_column(heading, justify="left" if heading == "joint" else "right")
    for i, name in enumerate(names):
        goal, position = sample.command_rad[i], sample.position_rad[i]
        told = (sample.current_ma, sample.temperature_c)
        motors = ("" if values is None else f"{values[i]:.0f}" for values in told)
        angles = (f"{math.degrees(x):.2f}" for x in (goal, position, position - goal))
        table.add_row(name, *angles, *motors)
    return table
