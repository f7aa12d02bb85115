"""The same batches on dask.distributed: a scheduler and workers on loopback, one of which is killed."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path

import pytest

from fpcad.errors import SpecError, ToolchainError
from fpcad.pipeline.hire import on_scheduler
from fpcad.pipeline.run import run_stages
from fpcad.workers import cluster
from fpcad.workers.cluster import ClusterWorkers
from tests.errands import Item, errand, open_badly, open_ten
from tests.pipeline.small import contents, small_build

ROOT = Path(__file__).parents[2]
LOOPBACK = ("--host", "127.0.0.1", "--no-dashboard", "--scheduler-file")


@dataclass(frozen=True)
class Cluster:
    """A scheduler and its workers."""

    address: str
    workers: list[subprocess.Popen]


@pytest.fixture(scope="module")
def machines(tmp_path_factory: pytest.TempPathFactory, bench, kernel_cache) -> Iterator[Cluster]:
    """Two dask workers of one thread each, which find the formulas compiled in their cache."""
    pytest.importorskip("distributed")
    folder = tmp_path_factory.mktemp("dask")
    (folder / "fpcad").mkdir()
    (folder / "fpcad" / "kernels").symlink_to(kernel_cache, target_is_directory=True)
    file = str(folder / "scheduler.json")
    own = ("--no-nanny", "--nthreads", "1", "--local-directory", str(folder))
    commands = [
        ["distributed.cli.dask_scheduler", "--port", "0", *LOOPBACK, file],
        *[["distributed.cli.dask_worker", *LOOPBACK, file, *own]] * 2,
    ]
    with (folder / "log").open("w") as log:
        started = [
            subprocess.Popen(
                [sys.executable, "-m", *command],
                cwd=ROOT,
                env={**os.environ, "XDG_CACHE_HOME": str(folder)},
                stdout=log,
                stderr=log,
            )
            for command in commands
        ]
    try:
        yield Cluster(address(folder / "scheduler.json"), started[1:])
    finally:
        for process in started:
            process.kill()
            process.wait()


def address(file: Path) -> str:
    """The scheduler's address, once it is there."""
    end = time.monotonic() + 120
    while not file.exists() or not file.read_text():
        assert time.monotonic() < end
        time.sleep(0.05)
    return json.loads(file.read_text())["address"]


class Killer:
    """A silent reporter that kills a process when so many steps of a stage are done."""

    def __init__(self, process: subprocess.Popen, stage: str, steps: int) -> None:
        self.process, self.at, self.left = process, stage, steps
        self.title = ""

    def stage(self, title: str, total: int | None):
        self.title = title
        return nullcontext(self)

    def advance(self, steps: int = 1, note: str = "") -> None:
        if self.title == self.at:
            self.left -= steps
            if self.left == 0:
                self.process.kill()

    def note(self, text: str) -> None:
        pass


def test_bad_items_are_told_as_on_one_machine(machines):
    items: list[Item] = [("", 1), ("raise", 2), ("exit", 3), *(("", n) for n in range(4, 60))]
    with ClusterWorkers(open_ten, machines.address) as workers:
        results = list(workers.map(errand, items, lambda item, reason: reason))
    assert results[:3] == [
        10,
        "raised ValueError: no 2 at <object object at 0x>",
        "crashed: exit code 7",
    ]
    assert results[3:] == [10 * number for _, number in items[3:]]


def test_what_the_opener_raises_there_is_raised_here(machines):
    with ClusterWorkers(open_badly, machines.address) as workers, pytest.raises(SpecError):
        list(workers.map(errand, [("", 1)]))


def test_a_worker_that_is_killed_loses_no_hand(tmp_path, kernel_cache, machines):
    alone = small_build(tmp_path / "alone", kernel_cache)
    run_stages(alone, "select")
    killer = Killer(machines.workers[0], "wielding the tool", steps=5)
    with on_scheduler(machines.address) as hire:
        together = small_build(tmp_path / "together", kernel_cache, reporter=killer, hire=hire)
        run_stages(together, "select")
    assert machines.workers[0].wait() == -9
    assert contents(together.folder) == contents(alone.folder)


def test_an_address_where_nothing_answers_is_told(monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setattr(cluster, "CONNECT_S", 0.2)
    with pytest.raises(ToolchainError, match="no dask scheduler answers at tcp"):
        ClusterWorkers(open_ten, "tcp://127.0.0.1:9")


def test_without_dask_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with (
        pytest.raises(ToolchainError, match=r"fpcad\[cluster\]") as told,
        on_scheduler("tcp://x:1"),
    ):
        pass
    assert len(str(told.value).splitlines()) == 1
