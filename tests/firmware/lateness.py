"""How late this machine runs what is due, so that tests in real time judge the program, not the load."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

PERIOD_S = 0.01
EXCUSE_S = 0.1
"""A machine that let a thread wait so long for its turn may have let the tested program wait too."""
TRIES = 3


class Lateness:
    """A thread that sleeps and notes how much longer that took than it should."""

    def __init__(self) -> None:
        self.worst_s = 0.0
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)

    def _watch(self) -> None:
        while not self._over.is_set():
            began = time.perf_counter()
            time.sleep(PERIOD_S)
            self.worst_s = max(self.worst_s, time.perf_counter() - began - PERIOD_S)

    def __enter__(self) -> Lateness:
        self._thread.start()
        return self

    def __exit__(self, *_error: object) -> None:
        self._over.set()
        self._thread.join()


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
                if lateness.worst_s < EXCUSE_S or left == 0:
                    error.add_note(f"the machine was {lateness.worst_s * 1e3:.0f} ms late at most")
                    raise
        print(f"\n{name}: the machine was {lateness.worst_s * 1e3:.0f} ms late; tried again")
