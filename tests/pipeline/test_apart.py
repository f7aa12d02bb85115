"""Work in a process of its own: how it ends, and what is told of it."""

from __future__ import annotations

import os
import signal

import pytest

from fpcad.errors import MakeError, StoreError
from fpcad.pipeline.apart import run_apart
from fpcad.workers.interface import TaskFailure


def counted(tell, item):
    for step in range(item):
        tell(f"step {step}")
    return os.getpid()


def crashing(tell, item):
    tell("the palm")
    os.kill(os.getpid(), item)


def endless(tell, item):
    tell("the thumb")
    while item:
        pass


def refusing(tell, item):
    raise item


def test_the_result_comes_from_another_process_after_all_that_it_tells():
    told = []
    assert run_apart(counted, 3, 60, told.append) != os.getpid()
    assert told == ["step 0", "step 1", "step 2"]


def test_a_crash_is_a_hand_that_cannot_be_made():
    with pytest.raises(MakeError, match=r"the CAD kernel ended \(SIGSEGV\) over the palm"):
        run_apart(crashing, signal.SIGSEGV, 60, lambda _: None)


def test_what_never_ends_is_ended():
    with pytest.raises(MakeError, match="took more than 4 s of processor time over the thumb"):
        run_apart(endless, True, 4, lambda _: None)


def test_errors_for_users_arrive_as_they_are():
    with pytest.raises(StoreError, match="somewhere is full"):
        run_apart(refusing, StoreError("somewhere is full"), 60, lambda _: None)


def test_a_fault_of_the_program_comes_with_its_traceback():
    with pytest.raises(TaskFailure, match=r"ZeroDivisionError(.|\n)*in refusing"):
        run_apart(refusing, ZeroDivisionError("one by none"), 60, lambda _: None)
