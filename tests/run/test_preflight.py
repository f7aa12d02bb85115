"""What is found before a port is opened, on a small hand that is written here."""

from types import SimpleNamespace

import numpy as np
import pytest

from fpcad.run.errors import CollisionError, MotorLimitsError
from fpcad.run.limits import JointLimits
from fpcad.run.preflight import (
    joint_torque_bound,
    preload_torque,
    require_apart,
    require_motors,
    require_torque,
)
from fpcad.run.quintic import Knots
from fpcad.run.self_collision import nearest_meeting, segment_distance
from fpcad.run.transmission import Transmission
from fpcad.run.urdf_chain import read_chain

LINK = """<link name="{name}"><inertial><origin xyz="0.05 0 0"/><mass value="0.1"/></inertial>
<collision><origin xyz="0.05 0 0" rpy="0 1.5707963267948966 0"/>
<geometry><cylinder radius="0.01" length="0.1"/></geometry></collision></link>"""
JOINT = """<joint name="{name}" type="revolute"><parent link="palm"/><child link="{child}"/>
<origin xyz="0 {y} 0"/><axis xyz="0 0 1"/><limit lower="-2" upper="2" velocity="3"/></joint>"""
NAMES = ("left", "right")


@pytest.fixture
def chain(tmp_path):
    """Two fingers of 100 mm, 60 mm apart, that turn about z in one plane."""
    file = tmp_path / "two.urdf"
    parts = [LINK.format(name="left_finger"), LINK.format(name="right_finger")]
    parts += [JOINT.format(name="left", child="left_finger", y=0.03)]
    parts += [JOINT.format(name="right", child="right_finger", y=-0.03)]
    file.write_text(f'<robot name="two"><link name="palm"/>{"".join(parts)}</robot>')
    return read_chain(file)


def hand(matrix=None, motor_type="STS3215-12V"):
    limits = JointLimits(
        NAMES, np.full(2, -2.0), np.full(2, 2.0), np.full(2, 4.5), np.full(2, 50.0), b""
    )
    motors = SimpleNamespace(type=motor_type, transmission=SimpleNamespace(spool_radius_mm=10.0))
    grip = SimpleNamespace(tendon_stiffness_n=12_000.0, tendon_length_mm=250.0)
    gears = Transmission(np.eye(2) if matrix is None else np.array(matrix), np.zeros(2))
    spec = SimpleNamespace(motors=motors, grip=grip)
    return SimpleNamespace(limits=limits, transmission=gears, motors=("m1", "m2"), spec=spec)


def motion(left, right, seconds=1.0, preload=None):
    rows = np.array([[0.0, 0.0], [left, right]])
    still = np.zeros((2, 2))
    grip = None if preload is None else np.tile(preload, (2, 1))
    return Knots(np.array([0.0, seconds]), rows, still, still, grip)


def test_gaps_are_those_of_plane_geometry(chain):
    parallel = nearest_meeting(chain, NAMES, np.zeros((1, 2)))
    assert parallel is not None
    assert parallel.gap_m == pytest.approx(0.06 - 0.02)
    bent = nearest_meeting(chain, NAMES, np.array([[-0.2, 0.2]]))
    assert bent is not None
    assert bent.gap_m == pytest.approx(0.06 - 2 * 0.1 * np.sin(0.2) - 0.02)


def test_segment_distances_agree_with_many_points():
    chance = np.random.default_rng(5)
    p1, q1, p2, q2 = chance.normal(size=(4, 40, 3))
    q1[:5] = p1[:5]  # spheres
    q2[5:10] = p2[5:10] + (q1[5:10] - p1[5:10])  # parallel
    share = np.linspace(0, 1, 301)
    for i, found in enumerate(segment_distance(p1, q1, p2, q2)):
        a = p1[i] + share[:, None] * (q1[i] - p1[i])
        b = p2[i] + share[:, None] * (q2[i] - p2[i])
        brute = np.linalg.norm(a[:, None] - b[None], axis=2).min()
        assert brute - 0.01 <= found <= brute + 1e-12


def test_fingers_that_would_meet_are_told_with_place_and_time(chain):
    require_apart(hand(), chain, motion(-0.15, 0.15))  # type: ignore[arg-type]
    with pytest.raises(CollisionError, match=r"left_finger and right_finger .* after \d\.\d+ s"):
        require_apart(hand(), chain, motion(-0.5, 0.5))  # type: ignore[arg-type]


def test_a_box_of_joints_is_no_box_of_motors():
    both = [[1.0, 1.0], [1.0, -1.0]]
    slow = motion(1.0, 1.0, seconds=0.7)  # each joint at 2.7 rad/s, the first motor at 5.4
    require_motors(hand(), slow)  # type: ignore[arg-type]
    with pytest.raises(MotorLimitsError, match=r"m1: its velocity reaches 5\.\d+ rad/s"):
        require_motors(hand(both), slow)  # type: ignore[arg-type]


def test_the_torque_bound_holds_a_resting_finger_and_no_less(chain):
    rest = joint_torque_bound(hand(), chain, motion(0.0, 0.0))  # type: ignore[arg-type]
    assert rest == pytest.approx(0.1 * 9.81 * 0.05)
    moved = joint_torque_bound(hand(), chain, motion(1.0, 0.0))  # type: ignore[arg-type]
    assert moved[0] >= rest[0]


def test_a_grip_beyond_the_motors_is_refused(chain):
    gentle, tight = motion(0, 0, preload=[0.1, 0]), motion(0, 0, preload=[0.9, 0])
    assert preload_torque(hand(), gentle) == pytest.approx([0.48, 0.0])  # type: ignore[arg-type]
    require_torque(hand(), chain, gentle)  # type: ignore[arg-type]
    with pytest.raises(MotorLimitsError, match=r"m1: would need 4\.\d+ N m"):
        require_torque(hand(), chain, tight)  # type: ignore[arg-type]
