"""How late this machine runs what is due, so that tests in real time judge the program, not the load."""

from __future__ import annotations

import os
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Any

PERIOD_S = 0.01
EXCUSE_S = 0.1
"""A machine that let a thread wait so long for its turn may have let the tested program wait too."""
CROWD_EXCUSE = 2.0
"""Programs ready to run for each core at which one that works all the time, as a simulated board does,
waits longer than it runs; a thread that mostly sleeps does not see that."""
TRIES = 3


class Lateness:
    """A thread that sleeps, and notes how much longer that took than it should, and who waits."""

    def __init__(self) -> None:
        self.worst_s = 0.0
        self.crowd = 0.0
        """Programs ready to run for each core, the greatest mean over a second."""
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)

    def _watch(self) -> None:
        recent: deque[float] = deque(maxlen=round(1 / PERIOD_S))
        while not self._over.is_set():
            began = time.perf_counter()
            time.sleep(PERIOD_S)
            self.worst_s = max(self.worst_s, time.perf_counter() - began - PERIOD_S)
            recent.append(ready_programs())
            if len(recent) == recent.maxlen:
                self.crowd = max(self.crowd, sum(recent) / len(recent) / (os.cpu_count() or 1))

    @property
    def excuses(self) -> bool:
        """Whether the machine may be why a program was late."""
        return self.worst_s >= EXCUSE_S or self.crowd >= CROWD_EXCUSE

    def __str__(self) -> str:
        return f"the machine was {self.worst_s * 1e3:.0f} ms late, {self.crowd:.1f} programs a core"

    def __enter__(self) -> Lateness:
        self._thread.start()
        return self

    def __exit__(self, *_error: object) -> None:
        self._over.set()
        self._thread.join()


def ready_programs() -> int:
    """Programs that run or wait for a core, but for this one."""
    with open("/proc/loadavg", encoding="ascii") as file:
        return int(file.read().split()[3].split("/")[0]) - 1


def judged_fairly(attempt: Callable[[], Any], name: str) -> Any:
    """Run a test in real time; once more where it failed while the machine itself was late.

    The last of three tries counts whatever the machine did, and a failure on a machine that was on
    time counts at once.
    """
    for left in reversed(range(TRIES)):
        with Lateness() as lateness:
            try:
                return attempt()
            except Exception as error:
                if not lateness.excuses or left == 0:
                    error.add_note(str(lateness))
                    raise
        print(f"\n{name}: {lateness}; tried again")
