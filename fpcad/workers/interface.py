"""What every kind of workers can do."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator
from types import TracebackType
from typing import Any, Generic, NoReturn, Self, TypeVar

from fpcad.errors import FpcadError

Context = TypeVar("Context")
Item = TypeVar("Item")
Result = TypeVar("Result")

Opener = Callable[[], Context]
"""Opens what all tasks work on; each worker does it once, so it must be picklable."""

Failed = Callable[[Item, str], Result]
"""The result that stands for an item whose task failed, from the item and the reason."""

MAX_REASON = 160
_ADDRESS = re.compile(r"0x[0-9a-fA-F]+")


class TaskFailure(FpcadError):
    """A task failed where no result can stand for it."""


def raise_failure(item: Any, reason: str) -> NoReturn:
    """The answer to a failed task of a caller that cannot do without it."""
    raise TaskFailure(f"a worker's task failed ({reason})")


class Workers(ABC, Generic[Context]):
    """Where tasks run: each worker opens the same context once and then runs tasks on it.

    Whatever the number of workers and wherever they are, the results are the same. Tasks, items and
    results must be picklable, and tasks be functions of importable modules.
    """

    @abstractmethod
    def map(
        self,
        task: Callable[[Context, Item], Result],
        items: Iterable[Item],
        failed: Failed[Item, Result] = raise_failure,
    ) -> Iterator[Result]:
        """Results of `task(context, item)` in the order of the items; one map at a time."""

    @abstractmethod
    def close(self) -> None:
        """End all workers at once, whatever they are doing."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


def describe_error(error: BaseException) -> str:
    """An exception as a reason: one line, the same in every run."""
    message = _ADDRESS.sub("0x", " ".join(str(error).split()))
    told = f"{type(error).__name__}: {message}" if message else type(error).__name__
    return f"raised {told}"[:MAX_REASON]
