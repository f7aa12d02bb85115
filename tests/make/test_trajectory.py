"""Whole trajectories of a real hand whose joints run into limits, and their files."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fpcad.errors import StoreError
from fpcad.make.quintic import MotionLimits
from fpcad.make.trajectory import Trajectory, build_trajectory
from fpcad.make.trajectory_file import read_trajectory, write_trajectory
from fpcad.spec.pose import Turning
from fpcad.units import RAD_PER_DEG
from tests.make.hands import STAMP
from tests.make.mechanism import Mechanism, mechanism

MOTOR_SPEED = np.full((4, 3), 4.0)
TILTED = Turning(axis=(0.1, -0.2, 1.0), pivot_mm=(4.0, 3.0, -2.0))


def turned_about(hand: Mechanism, turning: Turning) -> Mechanism:
    """The same pose, turned about another axis."""
    pose = hand.spec.poses[hand.pose].model_copy(update={"turning": turning})
    poses = {**hand.spec.poses, hand.pose: pose}
    return replace(hand, spec=hand.spec.model_copy(update={"poses": poses}))


def with_motion(hand: Mechanism, **motion: float) -> Mechanism:
    """The same hand with other limits of motion."""
    update = {"motion": hand.spec.motion.model_copy(update=motion)}
    return replace(hand, spec=hand.spec.model_copy(update=update))


def build(hand: Mechanism, minus: int = 20, plus: int = 25) -> Trajectory:
    path = hand.path(minus, plus)
    return build_trajectory(path, hand.spec, hand.geometry, hand.project, MOTOR_SPEED)


CASES = {
    "kinks": mechanism("carve", mcp_abd=(-5, 6)),
    "slow joints": with_motion(
        mechanism("carve", mcp_abd=(-5, 6)), joint_speed_deg_s=15, joint_acceleration_deg_s2=40
    ),
    "four contacts": mechanism("press"),
    "tilted axis": turned_about(mechanism("press"), TILTED),
}


@pytest.fixture(scope="module", params=CASES)
def case(request) -> tuple[Mechanism, Trajectory]:
    hand = CASES[request.param]
    return hand, build(hand)


@pytest.fixture(scope="module")
def carve() -> Trajectory:
    return build(CASES["kinks"])


def between_knots(trajectory: Trajectory, points: int = 10):
    """Times (M,) and tool angles (M,) inside the segments, the tool turning evenly in each."""
    share = np.linspace(0.0, 1.0, points + 2)[1:-1]
    time, angle = trajectory.time_s, trajectory.tool.angle_rad
    return [
        (values[:-1, None] + np.diff(values)[:, None] * share).ravel() for values in (time, angle)
    ]


def motion_limits(hand: Mechanism) -> MotionLimits:
    motion = hand.spec.motion
    return MotionLimits(
        motion.tool_speed_deg_s * RAD_PER_DEG,
        np.full(12, min(motion.joint_speed_deg_s * RAD_PER_DEG, 4.0)),
        np.full(12, motion.joint_acceleration_deg_s2 * RAD_PER_DEG),
    )


def test_contact_holds_at_knots_and_everywhere_between(case):
    hand, trajectory = case
    at_knots = hand.grip.gaps(trajectory.position_rad, trajectory.tool.angle_rad)
    assert np.abs(at_knots).max() < 0.005
    time, angle = between_knots(trajectory)
    assert np.abs(hand.grip.gaps(trajectory.joints()(time), angle)).max() < 0.008


def test_limits_of_motion_hold_everywhere(case):
    hand, trajectory = case
    limits, (time, _) = motion_limits(hand), between_knots(trajectory)
    joints = trajectory.joints()
    assert np.all(np.abs(joints(time, 1)) <= limits.joint_speed * (1 + 1e-9))
    assert np.all(np.abs(joints(time, 2)) <= limits.joint_acceleration * (1 + 1e-9))
    turning = np.abs(np.diff(trajectory.tool.angle_rad) / np.diff(trajectory.time_s))
    assert turning.max() <= limits.tool_speed * (1 + 1e-9)


def test_a_limit_is_nearly_always_in_use(case):
    hand, trajectory = case
    limits, (time, angle) = motion_limits(hand), between_knots(trajectory)
    joints = trajectory.joints()
    use = np.maximum(
        np.abs(joints(time, 1) / limits.joint_speed).max(axis=1),
        np.abs(joints(time, 2) / limits.joint_acceleration).max(axis=1),
    )
    use = np.maximum(use, np.abs(np.gradient(angle, time)) / limits.tool_speed)
    assert np.average(use > 0.9, weights=np.gradient(time)) > 0.65


def test_joint_ranges_hold_everywhere(case):
    hand, trajectory = case
    joints = trajectory.joints()(between_knots(trajectory)[0])
    assert np.all(joints >= hand.limits[0] - 1e-6) and np.all(joints <= hand.limits[1] + 1e-6)


def test_motion_rests_at_the_pose_and_at_both_ends_of_the_path(case):
    hand, trajectory = case
    angle = trajectory.tool.angle_rad
    plus, minus = int(np.argmax(angle)), int(np.argmin(angle))
    at_pose = np.flatnonzero(angle == 0.0)
    assert list(at_pose) == [0, at_pose[1], len(angle) - 1]
    assert 0 < plus < at_pose[1] < minus < len(angle) - 1
    resting = [*at_pose, plus, minus]
    assert np.abs(trajectory.velocity_rad_s[resting]).max() < 1e-12
    assert np.abs(trajectory.acceleration_rad_s2[resting]).max() < 1e-9
    for k in at_pose:
        np.testing.assert_array_equal(trajectory.position_rad[k], hand.posture)


def test_tool_reaches_both_ends_of_the_path(case):
    hand, trajectory = case
    path = hand.path(20, 25)
    angle = trajectory.tool.angle_rad
    assert angle.max() == pytest.approx(path.tool_angle_rad[-1], abs=1e-12)
    assert angle.min() == pytest.approx(path.tool_angle_rad[0], abs=1e-12)
    at_end = trajectory.position_rad[int(np.argmax(angle))]
    np.testing.assert_allclose(at_end, path.joints_rad[-1].ravel(), atol=1e-9)


def test_velocity_and_acceleration_fit_the_positions(case):
    _, trajectory = case
    joints, dense = trajectory.joints(), between_knots(trajectory, 40)[0]
    acceleration = np.gradient(joints(dense, 1), dense, axis=0)
    largest = np.abs(trajectory.acceleration_rad_s2).max()
    np.testing.assert_allclose(acceleration, joints(dense, 2), atol=0.05 * largest)


def test_tool_pose_turns_about_the_axis_through_the_pivot():
    hand = CASES["tilted axis"]
    trajectory = build(hand, 3, 3)
    pivot_axis = np.array([TILTED.pivot_mm, np.add(TILTED.pivot_mm, TILTED.axis)]) * 1e-3
    for point in pivot_axis:  # points of the axis stand still in the palm
        seen = [row[:3] + rotation(row[3:]) @ point for row in trajectory.tool.pose_palm]
        np.testing.assert_allclose(seen, np.broadcast_to(seen[0], (len(seen), 3)), atol=1e-12)
    first = rotation(trajectory.tool.pose_palm[0, 3:])
    for row, angle in zip(trajectory.tool.pose_palm, trajectory.tool.angle_rad, strict=True):
        cosine = (np.trace(first.T @ rotation(row[3:])) - 1) / 2
        assert cosine == pytest.approx(np.cos(angle), abs=1e-12)


def rotation(quaternion) -> np.ndarray:
    """Matrix of a unit quaternion w x y z."""
    w, x, y, z = quaternion
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + 2 * w * cross + 2 * cross @ cross


def test_quaternions_do_not_jump(carve: Trajectory):
    quaternions = carve.tool.pose_palm[:, 3:]
    assert np.all(np.einsum("ij,ij->i", quaternions[1:], quaternions[:-1]) > 0.99)
    np.testing.assert_allclose(np.linalg.norm(quaternions, axis=1), 1.0, atol=1e-14)


def test_motors_that_are_slower_than_the_spec_decide():
    hand = mechanism("carve")
    path, motors = hand.path(5, 5), np.full((4, 3), 0.05)
    trajectory = build_trajectory(path, hand.spec, hand.geometry, hand.project, motors)
    speed = np.abs(trajectory.joints()(between_knots(trajectory)[0], 1)).max()
    assert 0.049 < speed <= 0.05


def test_path_of_the_pose_alone_gives_a_motion_at_rest():
    hand = mechanism("carve")
    trajectory = build(hand, 0, 0)
    assert np.all(np.diff(trajectory.time_s) > 0)
    assert not trajectory.velocity_rad_s.any() and not trajectory.tool.angle_rad.any()
    np.testing.assert_array_equal(trajectory.position_rad, [hand.posture, hand.posture])


@pytest.mark.parametrize(("minus", "plus"), [(0, 4), (4, 0)])
def test_one_sided_path_gives_a_one_sided_motion(minus: int, plus: int):
    trajectory = build(mechanism("carve"), minus, plus)
    angle = trajectory.tool.angle_rad
    assert angle.max() == pytest.approx(np.radians(4.5 if plus else 0), abs=1e-12)
    assert angle.min() == pytest.approx(-np.radians(4.5 if minus else 0), abs=1e-12)
    assert angle[0] == angle[-1] == 0.0


def test_very_short_path_has_a_motion():
    hand = mechanism("carve")
    path = hand.path(0, 1, step=1e-3)
    trajectory = build_trajectory(path, hand.spec, hand.geometry, hand.project, MOTOR_SPEED)
    assert trajectory.tool.angle_rad.max() == pytest.approx(1.5e-3)


def test_same_path_gives_the_same_bytes(tmp_path: Path):
    for name in ("a.json", "b.json"):
        write_trajectory(build(CASES["kinks"], 3, 3), tmp_path / name, STAMP)
    assert (tmp_path / "a.json").read_bytes() == (tmp_path / "b.json").read_bytes()
    assert sorted(file.name for file in tmp_path.iterdir()) == ["a.json", "b.json"]


def test_file_has_the_keys_and_shapes_that_readers_expect(carve: Trajectory, tmp_path: Path):
    write_trajectory(carve, tmp_path / "carve.json", STAMP)
    document = json.loads((tmp_path / "carve.json").read_text())
    count = len(document["time_s"])
    assert document["joint_names"][:4] == [
        "thumb_mcp_flex",
        "thumb_mcp_abd",
        "thumb_ip_flex",
        "index_mcp_flex",
    ]
    for key in ("position_rad", "velocity_rad_s", "acceleration_rad_s2"):
        assert np.shape(document[key]) == (count, 12)
    assert document["contacts"][0] == {"finger": "thumb", "link": "distal"}
    tool = document["tool"]
    assert (tool["radius_m"], tool["back_m"], tool["tip_m"]) == (0.006, -0.08, 0.08)
    assert np.shape(tool["angle_rad"]) == (count,) and np.shape(tool["pose_palm"]) == (count, 7)


def test_file_is_read_as_it_was_written(carve: Trajectory, tmp_path: Path):
    preloaded = replace(carve, position_preload_rad=carve.position_rad + 0.01)
    for trajectory in (carve, preloaded):
        write_trajectory(trajectory, tmp_path / "carve.json", STAMP)
        again = read_trajectory(tmp_path / "carve.json")
        assert again.joint_names == trajectory.joint_names
        assert again.contacts == trajectory.contacts
        np.testing.assert_array_equal(again.position_rad, trajectory.position_rad)
        np.testing.assert_array_equal(again.tool.pose_palm, trajectory.tool.pose_palm)
        assert (again.position_preload_rad is None) == (trajectory.position_preload_rad is None)


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (lambda d: d.pop("time_s"), "the key 'time_s' is missing"),
        (lambda d: d["tool"].pop("angle_rad"), "the key 'angle_rad' is missing"),
        (lambda d: d["time_s"].reverse(), "time_s: at least two knots, increasing strictly"),
        (lambda d: d["position_rad"].pop(), "position_rad: .* finite numbers, not"),
        (lambda d: d["tool"].update(tip_m="far"), "could not convert"),
    ],
)
def test_damaged_file_is_refused(carve: Trajectory, tmp_path: Path, damage, message: str):
    file = tmp_path / "carve.json"
    write_trajectory(carve, file, STAMP)
    document = json.loads(file.read_text())
    damage(document)
    file.write_text(json.dumps(document))
    with pytest.raises(StoreError, match=message) as error:
        read_trajectory(file)
    assert str(file) in str(error.value)


def test_file_that_is_cut_off_is_refused(carve: Trajectory, tmp_path: Path):
    file = tmp_path / "carve.json"
    write_trajectory(carve, file, STAMP)
    file.write_text(file.read_text()[:-1000])
    with pytest.raises(StoreError):
        read_trajectory(file)


def test_failed_write_leaves_the_old_file(carve: Trajectory, tmp_path: Path, monkeypatch):
    file = tmp_path / "carve.json"
    file.write_text("old")

    def fails(*_):
        raise OSError("disk full")

    monkeypatch.setattr("os.fsync", fails)
    with pytest.raises(OSError, match="disk full"):
        write_trajectory(carve, file, STAMP)
    assert file.read_text() == "old" and list(tmp_path.iterdir()) == [file]


def test_a_grip_whose_goals_would_jump_slows_the_motion_there():
    hand = CASES["kinks"]
    path, loose = hand.path(20, 25), build(hand)
    end = np.abs(loose.tool.angle_rad).max()

    def goals(turn):
        """A step of 0.2 rad about the middle of the way, for every joint."""
        return np.tile(0.1 * np.tanh((np.abs(turn) - end / 2) / 0.02)[:, None], 12)

    paced = build_trajectory(path, hand.spec, hand.geometry, hand.project, MOTOR_SPEED, goals)
    allowed = hand.spec.motion.grip_speed_deg_s * RAD_PER_DEG

    def speed(trajectory):
        steps = np.abs(np.diff(goals(trajectory.tool.angle_rad), axis=0))
        return (steps / np.diff(trajectory.time_s)[:, None]).max()

    assert speed(loose) > 2 * allowed
    assert 0.9 * allowed < speed(paced) <= allowed * (1 + 1e-9)
    assert paced.duration_s < loose.duration_s + 4.0  # the rest of the way is as fast as before
