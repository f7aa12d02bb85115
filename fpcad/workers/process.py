"""The parent's side of one worker process."""

from __future__ import annotations

import os
import pickle
import signal
import socket
import subprocess
import sys
from contextlib import suppress
from multiprocessing.connection import Connection
from typing import Any

from fpcad.errors import ToolchainError
from fpcad.workers.child import START, Answer

SINGLE_THREADED = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Small matrices gain nothing from threads, and workers would contend for cores."""

STDERR = 2
LAST_WORDS_S = 5.0
"""Time between hanging up and being gone."""


class WorkerProcess:
    """A fresh Python process that holds a context and runs one task at a time.

    It is a plain child and not `multiprocessing`'s: that forbids children to daemons, which dask's
    workers are, and runs the main script anew in each.
    """

    def __init__(self, opener: bytes) -> None:
        """Start it; `opener` is the pickled opener of its context."""
        ours, theirs = socket.socketpair()
        with theirs:
            descriptor = theirs.fileno()
            self._process = subprocess.Popen(
                [sys.executable, "-c", START, str(descriptor), str(os.getpid()), *sys.path],
                pass_fds=[descriptor],
                stdin=subprocess.DEVNULL,
                stdout=STDERR,  # stdout is for the parent's results
                env={**dict.fromkeys(SINGLE_THREADED, "1"), **os.environ},
                start_new_session=True,  # Ctrl-C in the terminal is the parent's to answer
            )
        self.connection = Connection(ours.detach())
        self.opened = False
        self.assign(opener)

    def assign(self, message: bytes) -> bool:
        """Hand over a pickled (task, item); False when the process is gone."""
        try:
            self.connection.send_bytes(message)
        except (BrokenPipeError, ConnectionResetError):
            return False
        return True

    def receive(self) -> tuple[Answer, Any]:
        """The next answer; an error where its context cannot be opened, EOFError once it is gone."""
        try:
            kind, content = pickle.loads(self.connection.recv_bytes())
        except (EOFError, ConnectionResetError):
            if self.opened:
                raise EOFError from None
            raise ToolchainError(
                f"a worker process ended ({self.how_it_ended()}) before it could work; what it "
                "said stands above. Is there enough memory for that many workers?"
            ) from None
        if kind is Answer.UNOPENED:
            raise content
        self.opened = True
        return kind, content

    def how_it_ended(self) -> str:
        """How a process that has hung up went: a signal or an exit code."""
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(LAST_WORDS_S)
        self.stop()
        code = self._process.returncode
        return f"exit code {code}" if code >= 0 else signal.Signals(-code).name

    def stop(self) -> None:
        """End the process now."""
        self.connection.close()
        self._process.kill()
        self._process.wait()
