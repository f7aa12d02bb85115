"""fpcad's command line in a process that kills itself at a chosen step of writing files.

    python -m benchmarks.kill_at_step STEP ARGUMENTS...

Steps are counted over all files: before syncing, before renaming, after renaming, before the folder
is synced. With step 0 it lives, and says how many steps there were in the last line of stderr.
"""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path

from fpcad import store
from fpcad.cli import app


class Steps:
    """Counts steps and ends the process at one of them."""

    def __init__(self, last: int) -> None:
        self.last, self.count = last, 0

    def take(self) -> None:
        self.count += 1
        if self.count == self.last:
            os.kill(os.getpid(), signal.SIGKILL)

    def watch(self) -> None:
        """Count the steps of the store from now on."""
        sync, replace = store._sync, Path.replace

        def counted_sync(path: Path) -> None:
            self.take()
            sync(path)

        def counted_replace(path: Path, target: Path) -> Path:
            self.take()
            result = replace(path, target)
            self.take()
            return result

        store._sync, Path.replace = counted_sync, counted_replace  # pyright: ignore[reportAttributeAccessIssue]


def main() -> None:
    steps = Steps(int(sys.argv[1]))
    steps.watch()
    app(sys.argv[2:], standalone_mode=False)
    print(steps.count, file=sys.stderr)


if __name__ == "__main__":
    main()
