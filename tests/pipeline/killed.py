"""A run that kills itself at a chosen moment, as a power cut would.

Arguments: folder, folder of compiled formulas, number of the moment; a moment is a finished task, or
a step of writing a file: before it is synced, before it is renamed, after that, and when all is safe.
Without being killed the run prints how many moments there were.
"""

from __future__ import annotations

import os
import signal
import sys
from contextlib import nullcontext
from pathlib import Path

from fpcad import store
from fpcad.pipeline.run import run_stages
from tests.pipeline.small import small_build


class Moments:
    """Counts moments, and ends the process at one of them; reports as a silent reporter."""

    def __init__(self, last: int) -> None:
        self.last, self.count = last, 0

    def pass_one(self) -> None:
        self.count += 1
        if self.count == self.last:
            os.kill(os.getpid(), signal.SIGKILL)

    def stage(self, title: str, total: int | None):
        return nullcontext(self)

    def advance(self, steps: int = 1, note: str = "") -> None:
        self.pass_one()

    def note(self, text: str) -> None:
        self.pass_one()


def watch_files(moments: Moments) -> None:
    """Count every step of a file on its way to its place."""
    sync, replace = store._sync, Path.replace

    def counted_sync(path: Path) -> None:
        moments.pass_one()
        sync(path)

    def counted_replace(path: Path, target: Path) -> Path:
        moments.pass_one()
        result = replace(path, target)
        moments.pass_one()
        return result

    store._sync, Path.replace = counted_sync, counted_replace  # pyright: ignore[reportAttributeAccessIssue]


def main() -> None:
    root, kernels, last = Path(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3])
    moments = Moments(last)
    watch_files(moments)
    run_stages(small_build(root, kernels, reporter=moments), "select")
    print(moments.count)


if __name__ == "__main__":
    main()
