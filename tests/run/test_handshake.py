"""Controllers that do not fit, do not answer or are not homed: refused before anything moves."""

import numpy as np
import pytest

from fpcad.run.errors import (
    ConfigurationMismatch,
    ControllerSilent,
    JointMismatch,
    NotReady,
    ProtocolMismatch,
)
from tests.run.fixtures import NAMES, hand_limits
from tests.run.streaming import motion_frames, run
from tests.run.virtual import (
    VirtualLine,
    bit_flips,
    controller,
)

pytestmark = pytest.mark.usefixtures("each_controller")


@pytest.mark.parametrize(
    ("changes", "error", "words"),
    [
        ({"protocol": 3}, ProtocolMismatch, "version 3, this program 2"),
        ({"limits": hand_limits(configuration=b"x")}, ConfigurationMismatch, "transmission"),
        (
            {"limits": hand_limits(velocity_rad_s=np.full(12, 2.0))},
            ConfigurationMismatch,
            "thumb_mcp_flex: velocity limit 2 there",
        ),
    ],
)
def test_a_controller_that_does_not_fit_is_refused_without_motion(changes, error, words):
    line = VirtualLine(controller(**changes))
    with pytest.raises(error, match=words):
        run(line)
    assert motion_frames(line) == []


def test_another_number_of_joints_is_refused():
    ours = hand_limits()
    eleven = hand_limits(
        names=NAMES[:11],
        **{k: getattr(ours, k)[:11] for k in ("lower_rad", "upper_rad", "velocity_rad_s", "acceleration_rad_s2")},
    )  # fmt: skip
    line = VirtualLine(controller(limits=eleven, start_rad=np.zeros(11)))
    with pytest.raises(JointMismatch, match="11 joints, the trajectory 12"):
        run(line)
    assert motion_frames(line) == []


@pytest.mark.parametrize(
    ("to_host", "words"),
    [(lambda data: b"", "no answer within 5 s"), (bit_flips(1.0, 1), "no valid frame")],
)
def test_a_silent_controller_is_given_up(to_host, words):
    line = VirtualLine(to_host=to_host)
    with pytest.raises(ControllerSilent, match=words):
        run(line)
    assert 5.0 <= line.now_s < 5.1


def test_a_controller_that_boots_slowly_is_waited_for():
    late = VirtualLine()
    line = VirtualLine(to_device=lambda data: data if late.now_s > 0.7 else b"")
    line.on_tick = lambda line: setattr(late, "now_s", line.now_s)
    played, _ = run(line)
    assert played.final_state == "READY"


def test_an_unhomed_controller_is_not_run():
    line = VirtualLine(controller(homed=False))
    with pytest.raises(NotReady, match=r"IDLE.*not homed"):
        run(line)
    assert motion_frames(line) == []
