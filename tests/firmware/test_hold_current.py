"""A hand that holds keeps its grip with less current than one that moves may draw."""

import numpy as np

from fpcad.run.driver import Watch
from fpcad.run.firmware import FirmwareDriver
from fpcad.run.messages import Hold, State
from tests.firmware.core import core_controller
from tests.firmware.test_preload import closing
from tests.run.fixtures import hand_limits
from tests.run.virtual import VirtualLine

HOLD_MA = 200


def test_a_held_grip_draws_no_more_than_the_holding_current():
    line = VirtualLine(core_controller(hold_ma=HOLD_MA))
    driver = FirmwareDriver(line, hand_limits(), line.clock)
    driver.ready(clear=False)
    for motor in range(12):
        line.device.plant.jam(motor)  # on a tool that gives nothing
    driver.play(closing(), Watch(lambda _sample: None, lambda: 0))
    drawn = np.abs(line.device.look().current_ma[:12])
    assert drawn.max() > 5 * HOLD_MA
    driver._link.send_now(Hold())
    line.let_pass(0.1)
    held = np.abs(line.device.look().current_ma[:12])
    assert line.device.state is State.HOLD and line.device.plant.torque_on
    assert held.max() <= HOLD_MA
    np.testing.assert_allclose(held[drawn > HOLD_MA], HOLD_MA, atol=1)  # it still grips
