"""Tasks spread over processes, with results in the order of the tasks."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from types import TracebackType
from typing import Any, Generic, TypeVar

Context = TypeVar("Context")
Item = TypeVar("Item")
Result = TypeVar("Result")

SINGLE_THREADED = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")

_context: Any = None


class Workers(Generic[Context]):
    """Processes that each open the same context once and then run tasks on it.

    With one worker the tasks run in this process. Tasks and the opener must be picklable.
    """

    def __init__(self, open_context: Callable[[], Context], count: int) -> None:
        self._open, self.count = open_context, count
        self._pool: ProcessPoolExecutor | None = None
        self._local: Context | None = None

    def map(
        self, task: Callable[[Context, Item], Result], items: Iterable[Item]
    ) -> Iterator[Result]:
        """Results of `task(context, item)` in the order of the items."""
        if self.count == 1:
            if self._local is None:
                self._local = self._open()
            context = self._local
            return (task(context, item) for item in items)
        if self._pool is None:
            self._pool = _start_pool(self._open, self.count)
        return self._pool.map(_Task(task), items)

    def __enter__(self) -> Workers[Context]:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._pool is not None:
            self._pool.shutdown(wait=True, cancel_futures=True)


def available_cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class _Task(Generic[Context, Item, Result]):
    """A task bound to the worker's context, as a picklable function of the item alone."""

    def __init__(self, task: Callable[[Context, Item], Result]) -> None:
        self.task = task

    def __call__(self, item: Item) -> Result:
        return self.task(_context, item)


def _start_pool(open_context: Callable[[], Any], count: int) -> ProcessPoolExecutor:
    """Fresh processes: a fork would copy threads' locks. Small matrices gain nothing from threads."""
    for name in SINGLE_THREADED:
        os.environ.setdefault(name, "1")
    method = multiprocessing.get_context("spawn")
    return ProcessPoolExecutor(count, method, initializer=_open_context, initargs=(open_context,))


def _open_context(open_context: Callable[[], Any]) -> None:
    global _context
    _context = open_context()
