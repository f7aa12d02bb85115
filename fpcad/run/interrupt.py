"""Ctrl-C as a request that the run obeys in its own time, instead of an exception anywhere."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def counted_interrupts() -> Iterator[Callable[[], int]]:
    """Count interrupts while the context lasts; outside the main thread there are none to count."""
    count = 0

    def note(_signal: int, _frame: object) -> None:
        nonlocal count
        count += 1

    if threading.current_thread() is not threading.main_thread():
        yield lambda: 0
        return
    previous = signal.signal(signal.SIGINT, note)
    try:
        yield lambda: count
    finally:
        signal.signal(signal.SIGINT, signal.SIG_DFL if previous is None else previous)
