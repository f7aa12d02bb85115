"""Tasks run one after the other in this process."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

from fpcad.workers.interface import (
    Context,
    Failed,
    Opener,
    Workers,
    describe_error,
    raise_failure,
)

Item = TypeVar("Item")
Result = TypeVar("Result")


class InProcess(Workers[Context]):
    """No other process: nothing to start, but a task that crashes or hangs takes all with it."""

    def __init__(self, open_context: Opener[Context]) -> None:
        self._open = open_context
        self._context: Context | None = None

    def map(
        self,
        task: Callable[[Context, Item], Result],
        items: Iterable[Item],
        failed: Failed[Item, Result] = raise_failure,
    ) -> Iterator[Result]:
        if self._context is None:
            self._context = self._open()
        for item in items:
            try:
                result = task(self._context, item)
            except Exception as error:  # noqa: BLE001 - one bad item must not end the others
                result = failed(item, describe_error(error))
            yield result

    def close(self) -> None:
        self._context = None
