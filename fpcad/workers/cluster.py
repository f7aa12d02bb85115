"""Tasks spread over machines by dask.distributed; needs the extra `cluster`."""

from __future__ import annotations

import hashlib
import logging
import math
import pickle
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from importlib import import_module
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from fpcad.errors import ToolchainError
from fpcad.workers.interface import Context, Failed, Opener, Workers, raise_failure
from fpcad.workers.pool import ProcessPool

Item = TypeVar("Item")
Result = TypeVar("Result")

LARGEST_BATCH = 16
"""Items sent together: a message costs some milliseconds, and a lost worker this many items' time."""

BATCHES_AHEAD = 3
"""Batches a thread of the cluster that are on their way or done and not yet asked for."""

CONNECT_S = 30

JOB_MEMORY = "2 GB"
"""Of a SLURM job where dask-jobqueue's configuration says nothing; a worker takes under 1 GB."""

PACKAGE = Path(__file__).parents[1]


class Lost(NamedTuple):
    """Stands for the result of a task that failed."""

    reason: str


class ClusterWorkers(Workers[Context]):
    """Threads of dask workers, each with a process of its own that runs the tasks.

    A bad item is dealt with in that process exactly as on one machine. Dask gives the batches of a
    worker that is lost to another one.
    """

    def __init__(self, open_context: Opener[Context], scheduler: Any) -> None:
        """`scheduler` is what dask's client connects to: an address, or a cluster object."""
        distributed = import_dask("distributed")
        self._opener = pickle.dumps(open_context)
        try:
            self._client = distributed.Client(scheduler, timeout=CONNECT_S, set_as_default=False)
        except (OSError, ValueError) as error:
            raise ToolchainError(f"no dask scheduler answers at {scheduler}: {error}") from error

    def map(
        self,
        task: Callable[[Context, Item], Result],
        items: Iterable[Item],
        failed: Failed[Item, Result] = raise_failure,
    ) -> Iterator[Result]:
        items = list(items)
        threads = max(sum(self._client.nthreads().values()), 1)
        size = min(LARGEST_BATCH, max(math.ceil(len(items) / threads), 1))
        waiting = (items[i : i + size] for i in range(0, len(items), size))
        sent: deque[tuple[Sequence[Item], Any]] = deque()
        try:
            while True:
                for batch in islice(waiting, BATCHES_AHEAD * threads - len(sent)):
                    sent.append((batch, self._send(task, batch)))
                if not sent:
                    return
                batch, future = sent.popleft()
                for item, result in zip(batch, self._result(future), strict=True):
                    yield failed(item, result.reason) if isinstance(result, Lost) else result
        finally:
            self._client.cancel([future for _, future in sent])

    def close(self) -> None:
        self._client.close()

    def _send(self, task: Callable[[Context, Item], Any], batch: Sequence[Item]) -> Any:
        message = pickle.dumps((task, batch), protocol=pickle.HIGHEST_PROTOCOL)
        return self._client.submit(run_batch, self._opener, source_digest(), message, pure=False)

    def _result(self, future: Any) -> Sequence[Any]:
        """A batch's results; an error of the cluster's as one of ours."""
        distributed = import_dask("distributed")
        try:
            return future.result()
        except (distributed.KilledWorker, distributed.client.FutureCancelledError) as error:
            raise ToolchainError(
                f"the cluster gave up on a batch: {error}; the same command goes on from here"
            ) from error


@contextmanager
def slurm_cluster(jobs: int) -> Iterator[Any]:
    """A scheduler in this process, and workers as SLURM jobs of one core each, ended with the block.

    Queue, account, memory and time come from dask-jobqueue's configuration.
    """
    jobqueue = import_dask("dask_jobqueue")
    try:
        memory = jobqueue.core.dask.config.get("jobqueue.slurm.memory", None) or JOB_MEMORY
        cluster = jobqueue.SLURMCluster(
            cores=1, processes=1, memory=memory, scheduler_options={"dashboard": False}
        )
    except (OSError, RuntimeError, ValueError) as error:
        raise ToolchainError(f"no SLURM jobs: {' '.join(str(error).split())}") from error
    with cluster:
        cluster.scale(jobs=jobs)
        yield cluster


def import_dask(module: str) -> Any:
    """A module of the extra; :class:`ToolchainError` where it is missing."""
    try:
        imported = import_module(module)
    except ImportError as error:
        raise ToolchainError(
            f"{module} is missing ({error}): install it with `pip install 'fpcad[cluster]'`"
        ) from error
    logging.getLogger("distributed").setLevel(logging.WARNING)  # it tells every connection
    return imported


def run_batch(opener: bytes, digest: str, message: bytes) -> list[Any]:
    """On a dask worker: the results of a batch, in a process that this thread keeps for itself."""
    if digest != source_digest():
        raise ToolchainError("a dask worker runs another version of fpcad's code than this process")
    task, items = pickle.loads(message)
    return list(_own_pool(opener).map(task, items, lambda _, reason: Lost(reason)))


_own = threading.local()


def _own_pool(opener: bytes) -> ProcessPool[Any]:
    """One process for each thread, as long as the context is the same."""
    if getattr(_own, "opener", None) != opener:
        if hasattr(_own, "pool"):
            _own.pool.close()
        _own.opener, _own.pool = opener, ProcessPool(pickle.loads(opener), 1)
    return _own.pool


@cache
def source_digest() -> str:
    """Hash of the package's source code: other code could mean other results."""
    digest = hashlib.sha256()
    for source in sorted(PACKAGE.rglob("*.py")):
        digest.update(source.relative_to(PACKAGE).as_posix().encode() + b"\0" + source.read_bytes())
    return digest.hexdigest()
