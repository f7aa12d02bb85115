"""Workers keep the order of their items, survive bad ones, and never outlive their parent."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import pytest

from fpcad.errors import SpecError, ToolchainError
from fpcad.workers import InProcess, ProcessPool, TaskFailure
from tests import errands
from tests.errands import Item, crash_once, errand, open_and_die, open_badly, open_ten

ROOT = Path(__file__).parents[1]
MANY: list[Item] = [("", number) for number in range(40)]
BAD: list[Item] = [("", 1), ("raise", 2), ("exit", 3), ("", 4), ("crash", 5), ("leave", 6), ("", 7)]
REASONS = [
    10,
    "2: raised ValueError: no 2 at <object object at 0x>",
    "3: crashed: exit code 7",
    40,
    "5: crashed: SIGSEGV",
    "6: crashed: exit code 8",
    70,
]


def told(item: Item, reason: str) -> str:
    return f"{item[1]}: {reason}"


@pytest.fixture(scope="module")
def pair() -> Iterator[ProcessPool[int]]:
    """Two workers that all tests here may use, and that none can spoil."""
    with ProcessPool(open_ten, 2) as workers:
        yield workers


@pytest.mark.parametrize("count", [1, 2, 4])
def test_bad_items_are_told_with_their_reason_and_skew_nothing(count):
    with ProcessPool(open_ten, count) as workers:
        assert list(workers.map(errand, BAD, told)) == REASONS


def test_results_come_in_the_order_of_the_items(pair):
    assert list(pair.map(errand, MANY)) == [10 * number for _, number in MANY]


def test_one_process_raises_as_many_do():
    items = [item for item in BAD if item[0] in ("", "raise")]
    expected = [REASONS[BAD.index(item)] for item in items]
    assert list(InProcess(open_ten).map(errand, items, told)) == expected


def test_a_hanging_item_is_given_up_after_a_second_try():
    with ProcessPool(open_ten, 2, patience_s=0.3) as workers:
        items = [("hang", 1), ("", 2), ("", 3)]
        assert list(workers.map(errand, items, told)) == ["1: hung for 0.3 s", 20, 30]


def test_a_result_that_cannot_travel_is_a_failure(pair):
    (reason,) = pair.map(errand, [("unpicklable", 1)], told)
    assert reason.startswith("1: raised TypeError: cannot pickle")


def test_an_item_that_loses_its_process_once_is_not_lost(pair, tmp_path):
    assert list(pair.map(partial(crash_once, tmp_path / "flag"), [("", 1), ("", 2)])) == [10, 20]


def test_a_process_that_ends_between_tasks_is_replaced(pair):
    killed = set(pair.map(errands.process_id, MANY[:8]))
    for process in killed:
        os.kill(process, signal.SIGKILL)
    assert killed.isdisjoint(pair.map(errands.process_id, MANY[:8]))


def test_without_an_answer_for_failures_the_first_one_is_raised(pair):
    with pytest.raises(TaskFailure, match="raised ValueError: no 2"):
        list(pair.map(errand, BAD))
    assert list(pair.map(errand, MANY[:3])) == [0, 10, 20]


def test_an_abandoned_map_leaves_nothing_behind(pair):
    abandoned = pair.map(errand, MANY)
    assert next(abandoned) == 0
    abandoned.close()
    assert list(pair.map(errand, [("", 5)])) == [50]


def test_items_are_taken_only_as_they_are_needed(pair):
    taken = []
    results = pair.map(errand, (taken.append(number) or ("", number) for number in range(10_000)))
    assert next(results) == 0
    assert len(taken) < 100
    results.close()


def test_what_the_opener_raises_is_raised():
    with ProcessPool(open_badly, 2) as workers, pytest.raises(SpecError, match="nothing to open"):
        list(workers.map(errand, MANY))


def test_a_worker_that_never_opens_is_an_error():
    with ProcessPool(open_and_die, 1) as workers, pytest.raises(ToolchainError, match="code 3"):
        list(workers.map(errand, MANY))


def test_a_pool_without_processes_is_refused():
    with pytest.raises(ValueError, match="at least one"):
        ProcessPool(open_ten, 0)


@pytest.mark.parametrize("ending", [signal.SIGKILL, signal.SIGINT, signal.SIGTERM])
def test_workers_end_with_their_parent(tmp_path, ending):
    command = [sys.executable, "-c", "from tests.errands import main; main()", str(tmp_path)]
    # A shell's background job ignores SIGINT, and so would what it starts.
    heed = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    parent = subprocess.Popen(command, cwd=ROOT, stderr=subprocess.DEVNULL, preexec_fn=heed)
    eventually(lambda: len(list(tmp_path.glob("*.pid"))) == 2)
    parent.send_signal(ending)
    parent.wait(timeout=60)
    workers = [int(file.stem) for file in tmp_path.glob("*.pid")]
    eventually(lambda: not any(alive(worker) for worker in workers))


def eventually(condition: Callable[[], bool]) -> None:
    """Wait until a condition holds; the clock only ends a test that fails."""
    end = time.monotonic() + 60
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)


def alive(process: int) -> bool:
    """Whether a process exists and is not merely unburied."""
    stat = Path(f"/proc/{process}/stat")
    try:
        return stat.read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False
