"""Tasks for worker processes, good and bad, and what starts them; see test_workers.py."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from functools import partial
from pathlib import Path

from fpcad.errors import SpecError
from fpcad.workers import ProcessPool

Item = tuple[str, int]


def open_ten() -> int:
    """The context of all tasks here."""
    return 10


def open_badly() -> int:
    raise SpecError("nothing to open")


def open_and_die() -> int:
    os._exit(3)


def errand(ten: int, item: Item) -> int | object:
    """Ten times a number, or the mishap that the item names."""
    mishap, number = item
    match mishap:
        case "raise":
            raise ValueError(f"no {number}\nat {object()}")
        case "exit":
            os._exit(7)
        case "leave":
            sys.exit(8)
        case "crash":
            os.kill(os.getpid(), signal.SIGSEGV)
        case "hang":
            time.sleep(3600)
        case "unpicklable":
            return threading.Lock()
    return ten * number


def crash_once(flag: Path, ten: int, item: Item) -> int:
    """A task that loses its process the first time."""
    if not flag.exists():
        flag.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return ten * item[1]


def process_id(_: int, __: Item) -> int:
    return os.getpid()


def wait_for_ever(folder: Path, _: int, item: Item) -> None:
    """Leave a file with the process's id, and hang."""
    (folder / f"{os.getpid()}.pid").touch()
    time.sleep(3600)


def main() -> None:
    """A parent with two workers that hang; the argument is the folder for their ids."""
    with ProcessPool(open_ten, 2) as workers:
        list(workers.map(partial(wait_for_ever, Path(sys.argv[1])), [("", 1), ("", 2)]))
