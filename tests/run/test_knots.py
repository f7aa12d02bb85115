import numpy as np
import pytest

from fpcad.run.acceptance import first_violation
from fpcad.run.errors import TrajectoryError
from fpcad.run.knots import approach, from_wire, to_wire
from fpcad.run.quintic import Knots, evaluate
from tests.run.fixtures import hand_limits, swing


@pytest.mark.parametrize("rows", [11, 35, 61, 77, 151])
def test_the_wire_carries_the_motion_to_a_count(rows):
    wire = to_wire(swing(rows=rows))
    steps = np.diff([knot.t_us for knot in wire.messages])
    assert wire.error_rad < 1e-6
    assert steps.max() <= 100_001


def test_a_files_own_knots_are_kept():
    knots = swing(rows=61)
    assert [knot.t_us for knot in to_wire(knots).messages] == np.rint(knots.time_s * 1e6).tolist()


def test_a_few_close_knots_are_kept():
    coarse = swing(rows=41).time_s
    times = np.sort(np.concatenate([coarse, coarse[20:24] + 0.01]))
    m = evaluate(swing(rows=41), times)
    wire = to_wire(Knots(times, m.position, m.velocity, m.acceleration))
    assert wire.error_rad < 1e-6


def test_a_file_too_dense_for_the_line_is_thinned_within_its_bound():
    wire = to_wire(swing(rows=1001))
    assert len(wire.messages) == 68
    assert 0 < wire.error_rad < 1e-4


def test_a_file_too_rough_to_thin_is_refused():
    knots = swing(rows=1001)
    rough = knots.position + 2e-4 * np.random.default_rng(1).normal(size=knots.position.shape)
    rough[[0, -1]] = knots.position[[0, -1]]
    with pytest.raises(TrajectoryError, match="run it slower"):
        to_wire(Knots(knots.time_s, rough, knots.velocity, knots.acceleration))


def test_numbers_that_the_wire_cannot_hold_are_refused():
    knots = swing()
    knots.velocity[5, 3] = 3000.0
    with pytest.raises(TrajectoryError, match="too large to send"):
        to_wire(knots)


def test_a_burst_of_knots_is_kept_when_the_buffer_bridges_it():
    knots = swing(4.0, 81)
    times = np.unique(np.concatenate([knots.time_s, np.linspace(2.0, 2.4, 41)]).round(6))
    m = evaluate(knots, times)
    burst = Knots(times, m.position, m.velocity, m.acceleration)
    assert len(to_wire(burst).messages) == len(times)
    assert len(to_wire(burst, buffer_knots=24).messages) != len(times)


def test_wire_knots_rest_at_both_ends_whatever_the_duration():
    knots = swing(duration_s=2.0000004)
    first, *_, last = to_wire(knots).messages
    for knot in (first, last):
        assert not any(knot.velocity_urad_s) and not any(knot.acceleration_urad_s2)


@pytest.mark.parametrize("distance", [1e-5, 0.03, 1.0])
def test_the_way_to_the_start_is_slow_and_straight(distance):
    limits, knots = hand_limits(), swing()
    present = knots.position[0] - distance * np.linspace(0, 0.4, 12)
    path = approach(present, knots, limits, 0.2)
    way = path.time_s[1]
    motion = evaluate(path, np.linspace(0, way, 500))
    assert (np.abs(motion.velocity) <= 0.2 * limits.velocity_rad_s * (1 + 1e-9)).all()
    assert (np.abs(motion.acceleration) <= 0.2 * limits.acceleration_rad_s2 * (1 + 1e-9)).all()
    assert first_violation(from_wire(to_wire(path).messages), limits) is None
    np.testing.assert_allclose(path.time_s[1:] - way, knots.time_s)


def test_no_way_is_made_where_there_is_none():
    assert approach(swing().position[0], swing(), hand_limits(), 0.2).time_s[1] == swing().time_s[1]
