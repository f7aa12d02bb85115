"""Tasks spread over processes of this machine."""

from __future__ import annotations

import logging
import math
import os
import pickle
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from typing import Generic, TypeVar

from fpcad.workers.child import Answer
from fpcad.workers.interface import Context, Failed, Opener, Workers, raise_failure
from fpcad.workers.process import WorkerProcess

Item = TypeVar("Item")
Result = TypeVar("Result")

logger = logging.getLogger(__name__)

PATIENCE_S = 300.0
"""A task takes milliseconds to seconds; one that takes longer than this hangs."""

TRIES = 2
"""A task that kills its process or hangs gets another one, for it may not have been its fault."""

AHEAD = 32
"""Results a worker that may wait for an earlier one, so that memory stays bounded."""


class ProcessPool(Workers[Context]):
    """Processes of this machine; one that a task kills or blocks is replaced."""

    def __init__(
        self, open_context: Opener[Context], count: int, patience_s: float = PATIENCE_S
    ) -> None:
        if count < 1:
            raise ValueError(f"a pool needs at least one process, not {count}")
        self.count, self.patience_s = count, patience_s
        self._opener = pickle.dumps(open_context)
        self._idle: list[WorkerProcess] = []
        self._all: set[WorkerProcess] = set()

    def map(
        self,
        task: Callable[[Context, Item], Result],
        items: Iterable[Item],
        failed: Failed[Item, Result] = raise_failure,
    ) -> Iterator[Result]:
        batch = _Map(self, task, iter(items), failed)
        try:
            yield from batch.results()
        finally:
            batch.abandon()

    def close(self) -> None:
        for process in list(self._all):
            self.discard(process)
        self._idle.clear()

    def start(self) -> WorkerProcess:
        """A fresh process."""
        process = WorkerProcess(self._opener)
        self._all.add(process)
        return process

    def take(self) -> WorkerProcess:
        """An idle process, or a fresh one."""
        return self._idle.pop() if self._idle else self.start()

    def give_back(self, process: WorkerProcess) -> None:
        """A process that has no task any more."""
        self._idle.append(process)

    def discard(self, process: WorkerProcess) -> None:
        """End a process, whatever it is doing."""
        self._all.discard(process)
        process.stop()


def available_cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@dataclass
class _Assignment(Generic[Item]):
    """An item and its place among the items."""

    place: int
    item: Item
    tries: int = 0
    deadline: float = math.inf
    """On the monotonic clock [s]; there is none before the process has opened its context."""


class _Map(Generic[Context, Item, Result]):
    """One map: what is waiting, running and done."""

    def __init__(
        self,
        pool: ProcessPool[Context],
        task: Callable[[Context, Item], Result],
        items: Iterator[Item],
        failed: Failed[Item, Result],
    ) -> None:
        self._pool, self._task, self._failed = pool, task, failed
        self._items, self._begun, self._yielded = items, 0, 0
        self._again: deque[_Assignment[Item]] = deque()
        self._running: dict[Connection, tuple[WorkerProcess, _Assignment[Item]]] = {}
        self._done: dict[int, Result] = {}

    def results(self) -> Iterator[Result]:
        """Results in the order of the items."""
        self._assign()
        while self._running:
            self._await()
            self._assign()
            while self._yielded in self._done:
                result = self._done.pop(self._yielded)
                self._yielded += 1
                self._assign()
                yield result

    def abandon(self) -> None:
        """End the processes whose results nobody wants any more."""
        for process, _ in self._running.values():
            self._pool.discard(process)
        self._running.clear()

    def _assign(self) -> None:
        """Give each free process a task."""
        while len(self._running) < self._pool.count:
            if self._again:
                self._start(self._again.popleft(), self._pool.start())
            elif (assignment := self._following()) is not None:
                self._start(assignment, self._pool.take())
            else:
                return

    def _following(self) -> _Assignment[Item] | None:
        if self._begun - self._yielded >= AHEAD * self._pool.count:
            return None
        try:
            assignment = _Assignment(self._begun, next(self._items))
        except StopIteration:
            return None
        self._begun += 1
        return assignment

    def _start(self, assignment: _Assignment[Item], process: WorkerProcess) -> None:
        message = pickle.dumps((self._task, assignment.item), protocol=pickle.HIGHEST_PROTOCOL)
        if not process.assign(message):  # it was killed while it had nothing to do
            self._pool.discard(process)
            process = self._pool.start()
            process.assign(message)
        if process.opened:
            assignment.deadline = time.monotonic() + self._pool.patience_s
        self._running[process.connection] = (process, assignment)

    def _await(self) -> None:
        """Wait for an answer, an end, or the end of patience, and take note of it."""
        patience = min(assignment.deadline for _, assignment in self._running.values())
        left = None if patience == math.inf else max(patience - time.monotonic(), 0.0)
        for connection in wait(list(self._running), left):
            assert isinstance(connection, Connection)
            self._take_answer(connection)
        now = time.monotonic()
        for connection, (_, assignment) in list(self._running.items()):
            if assignment.deadline < now:
                self._give_up(connection, f"hung for {self._pool.patience_s:g} s")

    def _take_answer(self, connection: Connection) -> None:
        process, assignment = self._running[connection]
        try:
            kind, content = process.receive()
        except EOFError:
            self._give_up(connection, f"crashed: {process.how_it_ended()}")
            return
        if kind is Answer.OPENED:
            assignment.deadline = time.monotonic() + self._pool.patience_s
            return
        del self._running[connection]
        self._pool.give_back(process)
        if kind is Answer.FAILURE:
            reason, trace = content
            logger.info("%s", trace)
            content = self._failed(assignment.item, reason)
        self._done[assignment.place] = content

    def _give_up(self, connection: Connection, reason: str) -> None:
        """Try an item that took its process down once more, or let it be."""
        process, assignment = self._running.pop(connection)
        self._pool.discard(process)
        assignment.tries, assignment.deadline = assignment.tries + 1, math.inf
        if assignment.tries < TRIES:
            self._again.append(assignment)
        else:
            self._done[assignment.place] = self._failed(assignment.item, reason)
