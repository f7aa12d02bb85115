"""Homing behind the project's firmware: the host asks, the firmware searches and tells what it found."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fpcad.run.errors import ControllerSilent, HeldByUser, HomingError
from fpcad.run.limits import JointLimits, from_counts
from fpcad.run.link import Link
from fpcad.run.messages import (
    AskHoming,
    Hold,
    Home,
    HomingOutcome,
    HomingReport,
    Refused,
    State,
    Telemetry,
)

_LONGEST_S = 240.0
_ASK_S = 0.2


def home_controller(
    link: Link,
    limits: JointLimits,
    on_telemetry: Callable[[Telemetry, HomingReport | None], None],
    stops: Callable[[], int],
) -> HomingReport:
    """Let the controller search its zeros; what it found, or :class:`HomingError`."""
    link.send(Home())
    report, asked_s, begun = None, float("-inf"), False
    deadline = link.clock() + _LONGEST_S
    while link.clock() < deadline:
        if stops() > 0:
            link.send_now(Hold())
            raise HeldByUser("homing stopped: motors let go, zeros are unknown")
        if link.clock() - asked_s >= _ASK_S:
            asked_s = link.clock()
            link.send_now(AskHoming())
        for msg in link.poll():
            if isinstance(msg, Refused):
                raise HomingError(f"the controller refuses to home in {State(msg.state).name}")
            if isinstance(msg, HomingReport):
                report = msg
            if isinstance(msg, Telemetry):
                on_telemetry(msg, report)
                begun = begun or msg.state == State.HOMING
        over = report is not None and report.outcome != HomingOutcome.SEARCHING
        if begun and over and report is not None:
            return _checked(report, limits)
    raise ControllerSilent(f"the controller did not finish homing within {_LONGEST_S:g} s")


def _checked(report: HomingReport, limits: JointLimits) -> HomingReport:
    outcome = HomingOutcome(report.outcome)
    if outcome is HomingOutcome.FOUND:
        return report
    joint = limits.names[min(report.joint, len(limits.names) - 1)]
    turned = from_counts(report.upper_urad) - from_counts(report.lower_urad)
    words = {
        HomingOutcome.NO_END: "no end was found; is its tendon torn?",
        HomingOutcome.WRONG_RANGE: (
            f"it turns {np.degrees(turned[report.joint]):.0f} degrees between its ends, which is not "
            "the design's range; look for what blocks it"
        ),
        HomingOutcome.WRONG_SIGN: "it turns the other way; correct the motor's sign",
        HomingOutcome.STOPPED: "homing was stopped",
    }
    said = words.get(outcome, outcome.name.lower())
    raise HomingError(f"{joint}: {said}").leaving("Its motors let go, and its zeros are unknown.")
