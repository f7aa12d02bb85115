from dataclasses import replace

import numpy as np
import pyarrow.parquet as pq
import pytest
from ruamel.yaml import YAML

from benchmarks.paper.plain_hand import Capsule, gap
from benchmarks.paper.recheck import LIMITS, least_torque_share, measures, postures, recheck
from fpcad.model.equilibrium import least_torque
from fpcad.model.pose import HAND_SIZE
from fpcad.model.statics import cone_facets


@pytest.fixture(scope="module")
def first_postures(built_clay):
    spec = YAML(typ="safe").load(built_clay / "spec.yaml")
    row = pq.read_table(built_clay / "candidates.parquet").to_pylist()[0]
    return {posture.pose: posture for posture in postures(spec, row)}


def capsule(start, end, radius=1.0):
    return Capsule(np.array(start, dtype=float), np.array(end, dtype=float), radius)


@pytest.mark.parametrize(
    ("other", "distance"),
    [
        (capsule([5, -5, 4], [5, 5, 4]), 2.0),  # crossing
        (capsule([0, 5, 0], [10, 5, 0]), 3.0),  # parallel
        (capsule([13, 4, 0], [20, 4, 0]), 3.0),  # end to end
        (capsule([5, 0, 7], [5, 0, 7]), 5.0),  # a sphere
        (capsule([5, 0, 1], [5, 0, 9]), -1.0),  # overlapping
    ],
)
def test_gaps_of_capsules(other, distance):
    rod = capsule([0, 0, 0], [10, 0, 0])
    assert gap(rod, other) == pytest.approx(distance)
    assert gap(other, rod) == pytest.approx(distance)


def test_candidates_pass(built_clay):
    checked = recheck(built_clay, 1000)
    assert checked.all_within and checked.spacing >= 1.0
    assert checked.poses == 3 * checked.hands


@pytest.mark.parametrize(
    ("spoiled", "measure"),
    [
        ({"h": (0, 1e-5)}, "position"),
        ({"h": (3, 1e-6)}, "normals"),
        ({"h": (1, 1e-4)}, "touch"),
        ({"h": (2, 300.0)}, "bounds"),
        ({"d": (3, 2.0)}, "touch"),
    ],
)
def test_a_spoiled_pose_is_found_out(first_postures, spoiled, measure):
    for posture in first_postures.values():
        changed = {}
        for name, (place, change) in spoiled.items():
            changed[name] = getattr(posture, name).copy()
            changed[name][place] += change
        assert measures(replace(posture, **changed))[measure] > LIMITS[measure].most


def test_fingers_through_each_other_are_found_out(first_postures):
    for posture in first_postures.values():
        d = posture.d.copy()
        d[2] = 5.0
        assert measures(replace(posture, d=d))["overlap"] > 1.0


def test_equilibria_agree_with_the_package(bench, first_hand, first_postures):
    cap = bench.spec.statics.max_joint_torque_nmm
    for pose, posture in first_postures.items():
        y = first_hand.states[pose]
        values = bench.kernels[pose].statics(first_hand.design, y[:HAND_SIZE], 0.0, y[HAND_SIZE:])
        wrench, torque, tip = (value.copy() for value in values)
        force = bench.spec.poses[pose].tip_force_n
        ours = least_torque(wrench, torque, force * tip, cap, cone_facets(bench.spec.statics))
        assert ours is not None
        assert least_torque_share(posture, 1.0) == pytest.approx(
            ours.largest_torque_nmm / cap, rel=1e-6
        )
