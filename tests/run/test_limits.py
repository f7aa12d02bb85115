import numpy as np
import pytest

from fpcad.run.acceptance import first_violation
from fpcad.run.errors import TrajectoryError
from fpcad.run.knots import from_wire, to_wire
from fpcad.run.limits import read_limits, to_counts
from fpcad.run.messages import Reason
from fpcad.run.quintic import Knots, evaluate
from tests.run.fixtures import NAMES, hand_limits, swing

URDF = """<robot name="x"><link name="palm"/>
<joint name="a" type="revolute"><limit lower="-1" upper="2" velocity="3" effort="1"/></joint>
<joint name="skin" type="fixed"/>
<joint name="b" type="revolute"><limit lower="0" upper="1" velocity="4" effort="1"/></joint>
</robot>"""


def test_limits_are_read_from_a_urdf(tmp_path):
    file = tmp_path / "x.urdf"
    file.write_text(URDF)
    limits = read_limits(file, acceleration_rad_s2=5.0)
    assert limits.names == ("a", "b")
    np.testing.assert_array_equal(limits.lower_rad, [-1, 0])
    np.testing.assert_array_equal(limits.upper_rad, [2, 1])
    np.testing.assert_array_equal(limits.velocity_rad_s, [3, 4])
    np.testing.assert_array_equal(limits.acceleration_rad_s2, [5, 5])


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("<robot", "cannot read"),
        ("<!DOCTYPE robot><robot/>", "document type"),
        (URDF.replace('lower="-1" ', ""), "joint a: needs <limit>"),
        (URDF.replace('velocity="4"', 'velocity="fast"'), "joint b: needs <limit>"),
        (URDF.replace('velocity="4"', 'velocity="inf"'), "finite"),
        (URDF.replace('upper="1"', 'upper="-1"'), "lower limit must lie below"),
        ("<robot/>", "1 to 12 different joints"),
    ],
)
def test_a_faulty_urdf_is_named(tmp_path, text, complaint):
    file = tmp_path / "x.urdf"
    file.write_text(text)
    with pytest.raises(TrajectoryError, match=complaint) as caught:
        read_limits(file, 5.0)
    assert str(file) in str(caught.value)


def test_the_hash_tells_set_ups_apart():
    ours = hand_limits()
    other_limit = ours.upper_rad.copy()
    other_limit[7] += 2e-6
    swapped = (NAMES[1], NAMES[0], *NAMES[2:])
    others = [
        hand_limits(upper_rad=other_limit),
        hand_limits(names=swapped),
        hand_limits(configuration=b"other pulleys"),
    ]
    assert ours.hash() == hand_limits().hash()
    assert len({ours.hash(), *(limits.hash() for limits in others)}) == 4


def test_numbers_beyond_32_bits_are_refused():
    with pytest.raises(ValueError, match="32 bits"):
        to_counts([2200.0])
    with pytest.raises(ValueError, match="32 bits"):
        to_counts([float("nan")])


def test_a_motion_exactly_at_a_limit_passes_after_rounding():
    knots = from_wire(to_wire(swing()).messages)
    t = np.linspace(0, 2, 4001)
    exact = evaluate(swing(), t)
    limits = hand_limits(
        velocity_rad_s=np.abs(exact.velocity).max(axis=0),
        acceleration_rad_s2=np.abs(exact.acceleration).max(axis=0) * (1 + 1e-7),
    )
    assert first_violation(knots, limits) is None


@pytest.mark.parametrize("joint", [0, 5, 11])
def test_overshoot_between_legal_knots_is_found(joint):
    still = np.zeros((2, 12))
    position, velocity = np.tile(hand_limits().upper_rad, (2, 1)) - 0.01, still.copy()
    velocity[0, joint], velocity[1, joint] = 1.0, -1.0
    limits = hand_limits(acceleration_rad_s2=np.full(12, 1e3))
    found = first_violation(Knots(np.array([0, 0.1]), position, velocity, still), limits)
    assert found is not None
    assert (found.reason, found.joint) == (Reason.POSITION_LIMIT, joint)
    assert found.value > limits.upper_rad[joint]


@pytest.mark.parametrize(
    ("field", "factor", "reason"),
    [
        ("velocity_rad_s", 0.99, Reason.VELOCITY_LIMIT),
        ("acceleration_rad_s2", 0.99, Reason.ACCELERATION_LIMIT),
    ],
)
def test_a_percent_beyond_a_limit_is_found(field, factor, reason):
    motion = evaluate(swing(), np.linspace(0, 2, 4001))
    peak = motion.velocity if reason is Reason.VELOCITY_LIMIT else motion.acceleration
    limits = hand_limits(**{field: np.abs(peak).max(axis=0) * factor})
    found = first_violation(swing(), limits)
    assert found is not None and found.reason is reason
