"""A worker process: opens its context, then answers one task after the other."""

from __future__ import annotations

import ctypes
import os
import pickle
import signal
import sys
import traceback
from enum import IntEnum
from multiprocessing.connection import Connection
from typing import Any

from fpcad.workers.interface import describe_error

PR_SET_PDEATHSIG = 1

START = "import sys; sys.path[:] = sys.argv[3:]; from fpcad.workers.child import main; main()"
"""Program of a worker; its arguments are a file descriptor, the parent's id, and where to import."""


class Answer(IntEnum):
    """What an answer holds."""

    OPENED = 0
    """Nothing: the context is open."""
    UNOPENED = 1
    """The exception that opening it raised."""
    RESULT = 2
    """A task's result."""
    FAILURE = 3
    """A task's failure: its reason and its traceback."""
    TOLD = 4
    """What a task tells on its way, see :func:`tell`."""


_parent: Connection | None = None


def tell(content: Any) -> None:
    """Let the parent know something before the result; the parent must expect it."""
    if _parent is None:
        raise RuntimeError("only a worker has somebody to tell")
    _parent.send_bytes(_packed(Answer.TOLD, content))


def main() -> None:
    """Serve tasks until the parent hangs up or is gone."""
    descriptor, parent = int(sys.argv[1]), int(sys.argv[2])
    _die_with(parent)
    try:
        _serve(Connection(descriptor))
    except (EOFError, ConnectionError):
        return  # the parent hung up


def _serve(connection: Connection) -> None:
    global _parent
    _parent = connection
    try:
        context = connection.recv()()
    except Exception as error:  # noqa: BLE001 - told to the parent, which raises it
        connection.send_bytes(_packed(Answer.UNOPENED, error))
        return
    connection.send_bytes(_packed(Answer.OPENED, None))
    while True:
        connection.send_bytes(_run(context, connection.recv_bytes()))


def _run(context: Any, assignment: bytes) -> bytes:
    try:
        task, item = pickle.loads(assignment)
        return _packed(Answer.RESULT, task(context, item))
    except Exception as error:  # noqa: BLE001 - recorded by the parent; the next task goes on
        return _packed(Answer.FAILURE, (describe_error(error), traceback.format_exc()))


def _packed(answer: Answer, content: Any) -> bytes:
    return pickle.dumps((answer, content), protocol=pickle.HIGHEST_PROTOCOL)


def _die_with(parent: int) -> None:
    """Have Linux end this process with its parent, even in the middle of a task that hangs.

    Elsewhere a worker ends when it next looks for a task.
    """
    if sys.platform == "linux":
        libc = ctypes.CDLL(None, use_errno=True)
        if libc.prctl(PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0) != 0:
            raise OSError(ctypes.get_errno(), "prctl(PR_SET_PDEATHSIG)")
    if os.getppid() != parent:
        sys.exit()  # it was gone before that
