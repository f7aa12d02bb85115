"""What the command line shows: progress bars, tables and errors."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.logging import RichHandler
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    SpinnerColumn,
    Task,
    TaskID,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.text import Text

console = Console(stderr=True)
"""Progress and messages go to stderr; stdout is for results."""


class RateColumn(ProgressColumn):
    """Finished steps a second."""

    def render(self, task: Task) -> Text:
        """`12.3/s`, or nothing yet."""
        speed = task.finished_speed or task.speed
        return Text("" if speed is None else f"{speed:.1f}/s", style="progress.data.speed")


class ConsoleReporter:
    """Draws a bar for each stage, with rate and time left."""

    @contextmanager
    def stage(self, title: str, total: int | None) -> Iterator[Bar]:
        """A bar that stays with its final state when the stage ends."""
        columns = [TextColumn("{task.description:<24}"), SpinnerColumn(finished_text=" ")]
        if total is not None:
            columns += [BarColumn(28), MofNCompleteColumn(), RateColumn(), TimeRemainingColumn()]
        columns += [TimeElapsedColumn(), TextColumn("[dim]{task.fields[note]}")]
        with Progress(*columns, console=console) as progress:
            yield Bar(progress, progress.add_task(title, total=total, note=""))

    def note(self, text: str) -> None:
        """One line."""
        console.print(text, style="dim")


class Bar:
    """One stage's bar."""

    def __init__(self, progress: Progress, task: TaskID) -> None:
        self._progress, self._task = progress, task

    def advance(self, steps: int = 1, note: str = "") -> None:
        """Count finished steps; a note replaces the one before."""
        self._progress.advance(self._task, steps)
        if note:
            self._progress.update(self._task, note=note)


def start_logging(verbose: int) -> None:
    """Warnings always, -v tells what happens, -vv everything."""
    level = (logging.WARNING, logging.INFO, logging.DEBUG)[min(verbose, 2)]
    handler = RichHandler(console=console, show_path=verbose > 1, show_time=verbose > 0)
    logging.basicConfig(level=level, format="%(message)s", handlers=[handler], force=True)
