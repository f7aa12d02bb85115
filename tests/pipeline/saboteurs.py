"""Workers some of whose tasks fail in one of the ways that tasks can fail."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from fpcad.sample.rrt import Proposal
from fpcad.sample.tree import Candidate
from fpcad.solve.attempt import Workbench, open_workbench
from fpcad.spec.schema import Spec
from fpcad.workers import Failed, ProcessPool, raise_failure

MISHAPS = {3: "raise", 5: "exit", 7: "crash", 13: "nan"}
"""What befalls the hand, or the call, of a number."""


class Saboteurs(ProcessPool[Workbench]):
    """Processes in which certain tasks go wrong."""

    def map(
        self, task: Callable, items: Iterable, failed: Failed[Any, Any] = raise_failure
    ) -> Iterator[Any]:
        return super().map(Sabotaged(task), items, failed)


def hire_saboteurs(spec: Spec, cache: Path, count: int) -> Saboteurs:
    """Saboteurs in place of a build's processes."""
    return Saboteurs(partial(open_workbench, spec, cache), count)


class Sabotaged:
    """A task that goes wrong for some items."""

    def __init__(self, task: Callable) -> None:
        self.task = task

    def __call__(self, bench: Workbench, item: Candidate | tuple[Proposal, Any]) -> Any:
        number = item.id if isinstance(item, Candidate) else item[0].call
        match MISHAPS.get(number):
            case "raise":
                raise ZeroDivisionError("division by zero")
            case "exit":
                os._exit(1)
            case "crash":
                os.kill(os.getpid(), signal.SIGSEGV)
            case "nan":
                return self.task(bench, spoil(item))
        return self.task(bench, item)


def spoil(item: Any) -> Any:
    """The item with a number lost where the task begins."""
    if isinstance(item, Candidate):
        lost = {name: replace(s, y=s.y * np.nan) for name, s in item.poses.items()}
        return replace(item, poses=lost)
    proposal, states = item
    return proposal, {name: y * np.nan for name, y in states.items()}
