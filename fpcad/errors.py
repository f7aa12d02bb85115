"""Errors that users meet: each says where, what was found and what is allowed."""

from __future__ import annotations


class FpcadError(Exception):
    """A failure with a sentence for the user and an exit code for the shell.

    Subclasses pass all of their constructor's arguments to ``Exception`` so that they survive
    pickling between worker processes.
    """

    exit_code: int = 1


class SpecError(FpcadError):
    """The design file is faulty; the message lists every fault, one a line."""

    exit_code = 2


class SolveError(FpcadError):
    """No pose could be found where one is needed to go on."""

    exit_code = 3


class StoreError(FpcadError):
    """A build folder is damaged, incomplete or from another version."""

    exit_code = 4


class ToolchainError(FpcadError):
    """Something outside fpcad is missing; the message names what to install."""

    exit_code = 5


class MakeError(FpcadError):
    """A hand cannot be made: the message names the part or the motion that fails."""

    exit_code = 6
