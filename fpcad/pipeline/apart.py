"""Work in a process of its own: native code that crashes or never ends takes only that process with it."""

from __future__ import annotations

import logging
import pickle
import resource
from collections.abc import Callable
from functools import partial
from typing import Any, TypeVar

from fpcad.errors import FpcadError, MakeError
from fpcad.workers.child import Answer, tell
from fpcad.workers.interface import TaskFailure
from fpcad.workers.process import WorkerProcess

Result = TypeVar("Result")
Tell = Callable[[str], None]
Task = Callable[[Tell, Any], Result]
"""What is to be done with the item, telling each step."""

OUT_OF_TIME = "SIGXCPU"


def run_apart(task: Task[Result], item: Any, cpu_s: int, progress: Tell) -> Result:
    """The result of `task(tell, item)`, which runs in a fresh process; all of it must be picklable.

    Args:
        task: a function of an importable module.
        item: what it works on.
        cpu_s: processor time [s] after which the process is ended.
        progress: is told what the task tells.

    Raises:
        MakeError: the process was ended by a signal, its own or that of the time limit.
        FpcadError: what the task raised.
    """
    level = logging.getLogger().getEffectiveLevel()
    process = WorkerProcess(pickle.dumps(partial(_limited, cpu_s, level)))
    process.assign(pickle.dumps((_told, (task, item))))
    step = "its start"
    try:
        while True:
            kind, content = process.receive()
            if kind is Answer.TOLD:
                step = content
                progress(step)
            elif kind is not Answer.OPENED:
                return _outcome(kind, content)
    except EOFError:
        how = process.how_it_ended()
        what = (
            f"took more than {cpu_s} s of processor time"
            if how == OUT_OF_TIME
            else f"ended ({how})"
        )
        raise MakeError(f"the CAD kernel {what} over {step}") from None
    finally:
        process.stop()


def _outcome(kind: Answer, content: Any) -> Any:
    if kind is Answer.FAILURE:
        reason, traceback = content
        raise TaskFailure(f"a process apart failed ({reason})\n{traceback}")
    if isinstance(content, FpcadError):
        raise content
    return content


def _limited(cpu_s: int, level: int) -> None:
    """The process's context: none, but a limit on its processor time and the parent's loudness."""
    logging.basicConfig(level=level, format="%(message)s")
    _, hard = resource.getrlimit(resource.RLIMIT_CPU)
    resource.setrlimit(resource.RLIMIT_CPU, (cpu_s, hard))


def _told(_: None, assignment: tuple[Task[Any], Any]) -> Any:
    """The task's result, or the error that is meant for users."""
    task, item = assignment
    try:
        return task(tell, item)
    except FpcadError as error:
        return error
