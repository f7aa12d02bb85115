import json

import numpy as np
import pytest

from fpcad.run.errors import LimitsError, TrajectoryError
from fpcad.run.run_trajectory import dry_run
from fpcad.run.trajectory import in_order, read_trajectory, repeated, slowed
from tests.run.fixtures import NAMES, hand_limits, swing, trajectory_data, write_trajectory


def test_columns_are_brought_into_the_controllers_order(tmp_path):
    data = trajectory_data()
    order = np.random.default_rng(3).permutation(12)
    shuffled = {
        key: np.array(data[key])[:, order].tolist()
        for key in ("position_rad", "velocity_rad_s", "acceleration_rad_s2")
    }
    names = [NAMES[i] for i in order]
    file = write_trajectory(tmp_path, **shuffled, joint_names=names)
    knots = in_order(read_trajectory(file), hand_limits())
    np.testing.assert_array_equal(knots.position, swing().position)


def changed(key, index, value):
    def change(data):
        rows = np.array(data[key])
        rows[index] = value
        data[key] = rows.tolist()

    return change


def without(key):
    return lambda data: data.pop(key)


def put(key, value):
    return lambda data: data.__setitem__(key, value)


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        (without("time_s"), "missing time_s"),
        (without("velocity_rad_s"), "missing velocity_rad_s"),
        (put("joint_names", "thumb"), "joint_names: must be a list"),
        (put("joint_names", [*NAMES[:11], NAMES[0]]), "stands twice"),
        (put("joint_names", [*NAMES[:11], "ring_ip_felx"]), "did you mean ring_ip_felx"),
        (put("time_s", [0.0]), "at least two"),
        (changed("time_s", 7, 0.0), r"time_s\[7\]: must be greater"),
        (changed("time_s", 7, np.nan), "time_s: must be finite"),
        (changed("position_rad", (3, 4), np.inf), "position_rad: must be finite"),
        (put("position_rad", [[0.0] * 12] * 3), r"position_rad: shape \(3, 12\)"),
        (put("position_rad", [[0.0], [0.0, 1.0]]), "rows of equal length"),
        (put("acceleration_rad_s2", "none"), "must hold numbers"),
        (changed("velocity_rad_s", (0, 2), 0.1), "velocity_rad_s: must be zero in the first"),
        (changed("acceleration_rad_s2", (-1, 2), 0.1), "acceleration_rad_s2: must be zero"),
    ],
)
def test_a_faulty_file_is_named(tmp_path, change, complaint):
    data = trajectory_data()
    change(data)
    file = tmp_path / "swing.json"
    file.write_text(json.dumps(data))
    with pytest.raises(TrajectoryError, match=complaint):
        dry_run(file, hand_limits())


@pytest.mark.parametrize("text", ["", "{", "[1, 2]"])
def test_what_is_no_trajectory_is_refused(tmp_path, text):
    file = tmp_path / "swing.json"
    file.write_text(text)
    with pytest.raises(TrajectoryError, match=r"swing\.json"):
        read_trajectory(file)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(TrajectoryError, match=r"nowhere\.json"):
        read_trajectory(tmp_path / "nowhere.json")


def test_limits_are_held_between_knots_too(tmp_path):
    limits = hand_limits(velocity_rad_s=np.full(12, 0.2))
    with pytest.raises(LimitsError, match=r"velocity reaches .* allowed is .*0\.2 rad/s"):
        dry_run(write_trajectory(tmp_path), limits)
    slow = dry_run(write_trajectory(tmp_path), limits, speed=0.25)
    assert slow.seconds == pytest.approx(8.0)


@pytest.mark.parametrize("speed", [0.0, -1.0, 1.5, float("nan")])
def test_speeds_beyond_the_trajectorys_are_refused(speed):
    with pytest.raises(TrajectoryError, match="speed"):
        slowed(swing(), speed)


def test_loops_repeat_the_motion():
    knots = repeated(swing(), 3)
    assert knots.time_s[-1] == pytest.approx(6.0) and len(knots.time_s) == 181
    np.testing.assert_array_equal(knots.position[61:121], swing().position[1:])


def test_an_open_trajectory_does_not_loop():
    knots = swing()
    knots.position[-1] += 0.1
    with pytest.raises(TrajectoryError, match="does not end where it starts"):
        repeated(knots, 2)
