import numpy as np
import pytest

from fpcad.run.errors import TrajectoryError
from fpcad.run.firmware_setup import FirmwareSetup, setup_source
from fpcad.run.messages import State
from fpcad.run.transmission import Transmission, direct, read_transmission
from tests.firmware.core import core_controller
from tests.run.fixtures import NAMES, hand_limits, swing

BLOCK = np.array([[1.0, 1.0, 0.0], [1.0, -1.0, 0.0], [0.4, 0.0, 0.5]])
YAML = f"""# Motor angles from joint angles.
joints: [{", ".join(NAMES)}]
matrix: {np.kron(np.eye(4), BLOCK).tolist()}
offset_rad: {np.linspace(-1, 1, 12).tolist()}
""".encode()


def test_a_builds_transmission_is_cut_into_fingers():
    gears = read_transmission(YAML, NAMES)
    assert gears.group == 3
    np.testing.assert_array_equal(gears.blocks(gears.matrix), np.tile(BLOCK, (4, 1)))
    assert direct(11).group == 1


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        (b"joints", b"joint", "cannot be read"),
        (b"ring_ip_flex", b"ring_ip", "the URDF has"),
        (b"[[1.0", b"[[.nan", "finite"),
        (b"[[1.0, 1.0", b"[[1.0, -1.0", "cannot move each joint"),
    ],
)
def test_a_faulty_transmission_is_named(old, new, complaint):
    with pytest.raises(TrajectoryError, match=complaint):
        read_transmission(YAML.replace(old, new), NAMES)


def test_joints_that_all_share_motors_are_too_many():
    with pytest.raises(TrajectoryError, match="more than 4 joints"):
        _ = Transmission(np.eye(12) + 0.1, np.zeros(12)).group


def test_the_firmware_goes_through_the_differential_and_back():
    device = core_controller(limits=hand_limits(configuration=YAML))
    for _ in range(50):
        device.tick()
    assert device.state is State.READY
    # A count in a motor is up to two counts in a joint.
    np.testing.assert_allclose(device.measured, swing().position[0], atol=3e-6)


def test_a_board_gets_its_hand_as_c():
    source = setup_source(FirmwareSetup(hand_limits(configuration=YAML)), swing().position[0])
    assert ".group = 3," in source and "{16777216, -16777216, 0}" in source
    assert source.count(".joints = 12,") == 1 and "HAND_START_RAD" in source
