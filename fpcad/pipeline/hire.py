"""Where a build's workers come from; its results do not depend on it."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from fpcad.solve.attempt import Workbench, open_workbench
from fpcad.spec.schema import Spec
from fpcad.store import waiting_for
from fpcad.workers import ProcessPool, Workers

Hire = Callable[[Spec, Path, int], Workers[Workbench]]
"""Takes on a number of workers for a spec; the path is this machine's cache of formulas."""


def processes(spec: Spec, cache: Path, count: int) -> Workers[Workbench]:
    """Processes of this machine."""
    return ProcessPool(partial(open_workbench, spec, cache), count)


@contextmanager
def on_scheduler(address: str) -> Iterator[Hire]:
    """The workers of a dask scheduler that runs already, as tcp://host:8786: all it has."""
    from fpcad.workers.cluster import ClusterWorkers, import_dask

    import_dask("distributed")  # told now, not after the first stage
    yield lambda spec, _, __: ClusterWorkers(partial(open_there, spec), address)


@contextmanager
def on_slurm(jobs: int) -> Iterator[Hire]:
    """SLURM jobs of one core each, the same ones for all stages."""
    from fpcad.workers.cluster import ClusterWorkers, slurm_cluster

    with slurm_cluster(jobs) as cluster:
        yield lambda spec, _, __: ClusterWorkers(partial(open_there, spec), cluster)


def open_there(spec: Spec) -> Workbench:
    """Open a workbench on whatever machine this is; the first there compiles, the others wait."""
    folder = machine_cache()
    with waiting_for(folder):
        return open_workbench(spec, folder)


def machine_cache() -> Path:
    """Folder of compiled formulas of this user on this machine."""
    caches = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(caches) / "fpcad" / "kernels"
