import os
import time

import pytest

from tests.firmware import lateness
from tests.firmware.lateness import Lateness, judged_fairly, ready_programs


class Late(Lateness):
    """A machine that was late."""

    def __enter__(self):
        self.worst_s = 0.5
        return super().__enter__()


def failing(times):
    """Fails so many times, then succeeds."""
    tries = []

    def attempt():
        tries.append(True)
        if len(tries) <= times:
            raise ValueError("wrong")
        return len(tries)

    return attempt


def test_lateness_and_crowd_are_measured(monkeypatch):
    monkeypatch.setattr(lateness, "ready_programs", lambda: 7 * (os.cpu_count() or 1))
    with Lateness() as machine:
        time.sleep(3.0)
    assert 0 <= machine.worst_s < 5 and machine.crowd == 7 and machine.excuses


def test_those_who_are_ready_to_run_are_counted():
    assert 0 <= ready_programs() < 10_000


def test_a_failure_on_a_machine_that_is_on_time_counts(monkeypatch):
    monkeypatch.setattr(lateness, "EXCUSE_S", 1e9)
    monkeypatch.setattr(lateness, "CROWD_EXCUSE", 1e9)
    with pytest.raises(ValueError, match="wrong") as caught:
        judged_fairly(failing(1), "x")
    assert "the machine was" in caught.value.__notes__[0]


def test_a_failure_on_a_late_machine_is_tried_again_but_not_for_ever(monkeypatch, capsys):
    monkeypatch.setattr(lateness, "Lateness", Late)
    assert judged_fairly(failing(2), "this test") == 3
    assert "this test: the machine was 500 ms late" in capsys.readouterr().out
    with pytest.raises(ValueError, match="wrong"):
        judged_fairly(failing(3), "x")
