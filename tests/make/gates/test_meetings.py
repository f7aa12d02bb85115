"""No two parts of a hand may meet, and the gates say which do, where, and how close the others come."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from fpcad.make.gates.all_gates import PARTS, gate_groups
from fpcad.make.gates.approach import closest_approach
from fpcad.make.gates.bodies import body_of, hand_bodies, link_poses
from fpcad.make.gates.bounds import least_distance
from fpcad.make.gates.finding import Severity, errors
from fpcad.make.gates.fixed import check_fixed
from fpcad.make.gates.joints import check_joints, joint_grid
from fpcad.make.gates.meeting import meet, nearby
from fpcad.make.gates.meetings import check_meetings, tool_bodies, tool_mesh
from fpcad.make.gates.postures import STEP_RAD, Postures, rest_joints
from fpcad.make.gates.reach import check_reach
from fpcad.make.parts.assembly import Assembly
from fpcad.model.geometry import link_poses as model_poses
from tests.make.hands import CENTRE, CLAY, TEMPLATE, assembly_of, design, geometry_of

GEOMETRY = geometry_of(CENTRE)
HERE = np.eye(4)


@pytest.fixture(scope="module")
def assembly():
    return assembly_of(CENTRE)


@pytest.fixture(scope="module")
def bodies(assembly):
    return hand_bodies(assembly, GEOMETRY)


def shifted(x: float) -> np.ndarray:
    pose = np.eye(4)
    pose[0, 3] = x
    return pose


def cube(size: float):
    return body_of("cube", "palm", trimesh.creation.box((size, size, size)))


def with_part(assembly, name, **changes):
    """The assembly with one of its parts changed."""
    parts = [replace(p, **changes) if p.name == name else p for p in assembly.parts]
    return Assembly(tuple(parts), assembly.bought)


def turned(*angles_deg) -> np.ndarray:
    """Joints of the whole hand, all fingers at the same angles."""
    return np.tile(np.deg2rad(angles_deg), (1, len(GEOMETRY.fingers), 1))


def test_bodies_move_like_the_model():
    u = np.deg2rad(np.random.default_rng(1).uniform(-30, 60, (4, 3)))
    expected = model_poses(TEMPLATE, design(CENTRE), u)
    for i, finger in enumerate(GEOMETRY.fingers):
        for link in ("proximal", "distal"):
            pose = link_poses(GEOMETRY, finger, link, u[i : i + 1])[0]
            assert pose == pytest.approx(expected[finger][link], abs=1e-12)


@pytest.mark.parametrize(
    ("x", "gap", "volume"), [(3.5, 0.5, 0), (3.0, 0, 0), (2.5, 0, 2), (0, 0, 8)]
)
def test_two_cubes_meet(x, gap, volume):
    found, shared = meet(cube(4), HERE, cube(2), shifted(x), 1.0)
    assert found == pytest.approx(gap)
    assert (shared.volume_mm3 if shared else 0) == pytest.approx(volume)


def test_no_body_is_nearer_than_its_bound(bodies):
    rng = np.random.default_rng(2)
    palm = next(b for b in bodies if b.part == "palm")
    skin = next(b for b in bodies if b.part == "distal_skin")
    poses = link_poses(GEOMETRY, "index", "distal", np.deg2rad(rng.uniform(-10, 100, (60, 3))))
    bound = least_distance(palm, np.broadcast_to(HERE, poses.shape), skin, poses)
    real = [meet(palm, HERE, skin, pose, 10.0)[0] for pose in poses]
    assert np.all(np.minimum(bound, 10.0) <= np.array(real) + 1e-9) and (bound > 0).any()


@pytest.mark.parametrize(("within", "least"), [(0.1, 0.1), (0.6, 0.25), (5.0, 0.25)])
def test_the_closest_approach_is_the_least_distance_of_all_postures(within, least):
    """A cube above another one, at heights of which the least leaves 0.25 mm."""
    poses = np.tile(HERE, (30, 1, 1))
    poses[:, 2, 3] = np.random.default_rng(3).permutation(np.linspace(3.25, 6.0, 30))
    poses[:, :2, 3] = np.random.default_rng(4).uniform(-1, 1, (30, 2))
    moved = replace(cube(2), finger="index")
    found = closest_approach(cube(4), np.broadcast_to(HERE, poses.shape), moved, poses, within)
    assert found.overlap is None and found.gap_mm == pytest.approx(least)


def test_an_approach_ends_at_an_overlap_and_names_the_posture():
    poses = np.stack([shifted(x) for x in (4.0, 3.5, 2.5, 2.0)])
    moved = replace(cube(2), finger="index")
    found = closest_approach(cube(4), np.tile(HERE, (4, 1, 1)), moved, poses, 1.0)
    assert found.posture == 2 and found.gap_mm == 0
    assert found.overlap and found.overlap.volume_mm3 == pytest.approx(2)


def test_a_joints_grid_has_its_limits_its_rest_and_small_steps():
    grid = joint_grid(CLAY.hand, "mcp_flex")
    assert np.rad2deg(grid[[0, -1]]) == pytest.approx(CLAY.hand.joint_limits_deg["mcp_flex"])
    assert np.diff(grid).max() <= STEP_RAD + 1e-12 and np.abs(grid).min() == 0


def test_the_centre_hands_joints_move_freely(assembly, bodies):
    found = check_joints(bodies, GEOMETRY, CLAY.hand) + check_fixed(bodies, GEOMETRY)
    assert errors(found) == [] and all(f.value > 0 for f in found)


def test_the_centre_hand_is_free_at_rest_and_tells_its_clearance(bodies):
    at_rest = Postures("at rest", rest_joints(CLAY.hand, GEOMETRY)[None])
    (told,) = check_meetings(bodies, tool_bodies(CLAY), GEOMETRY, at_rest)
    assert told.severity is Severity.FIGURE and 0.1 < told.value <= 2


def test_parts_that_overlap_in_a_link_are_refused(assembly):
    thick = next(p.mesh.copy() for p in assembly.parts if p.name == "proximal_skin")
    thick.apply_transform(np.diag([1, 0.9, 0.9, 1]))
    fault = check_fixed(
        hand_bodies(with_part(assembly, "proximal_skin", mesh=thick), GEOMETRY), GEOMETRY
    )
    assert "proximal_bone and thumb proximal_skin" in fault[0].part and fault[0].value > 10


def test_a_joint_that_is_stuck_is_refused_with_its_angles(assembly):
    longer = next(p.mesh.copy() for p in assembly.parts if p.name == "distal_skin")
    longer.apply_translation((-3, 0, 0))
    bad = hand_bodies(with_part(assembly, "distal_skin", mesh=longer), GEOMETRY)
    faults = errors(check_joints(bad, GEOMETRY, CLAY.hand))
    assert {f.gate for f in faults} == {"joint"} and "IP " in faults[0].text


def test_parts_are_judged_first_and_no_gate_is_left_out(assembly):
    titles = [title for title, _ in gate_groups(CLAY, assembly, GEOMETRY, {})]
    reaches = [f"reach of {finger}" for finger in GEOMETRY.fingers]
    assert titles == [PARTS, "pad", "fixed parts", "tubes", "joints", "at rest", *reaches]


def test_what_is_cut_out_nearby_keeps_distances_and_volumes():
    """A ball in front of a plate, some postures through it."""
    plate = body_of("plate", "palm", trimesh.creation.box((80.0, 80.0, 4.0)))
    ball = body_of("ball", "distal", trimesh.creation.icosphere(3, 3.0), finger="index")
    poses = np.tile(HERE, (12, 1, 1))
    poses[:, 2, 3] = np.linspace(4.0, 7.0, 12)
    close = nearby(plate, ball, poses, 1.0)
    assert close.solid.volume() < 0.1 * plate.solid.volume()
    for pose in poses:
        whole, cut = (meet(body, HERE, ball, pose, 1.0) for body in (plate, close))
        assert cut[0] == pytest.approx(whole[0], abs=1e-9)
        assert (cut[1] is None) == (whole[1] is None)
        if whole[1] is not None and cut[1] is not None:
            assert cut[1].volume_mm3 == pytest.approx(whole[1].volume_mm3)
    assert nearby(plate, ball, poses[:2], 1.0) is plate


def test_fingers_that_cross_at_rest_are_refused_and_the_rest_posture_is_named(bodies):
    crossing = Postures("at rest", turned(75, 0, 0))
    faults = errors(check_meetings(bodies, tool_bodies(CLAY), GEOMETRY, crossing))
    assert any("thumb" in f.part and "hand.rest_posture_deg" in f.text for f in faults)


def test_the_tool_meets_only_whom_it_may_touch(bodies):
    """A stick across a straight index finger, as far off as both radii, is touched and no more."""
    root = GEOMETRY.T_palm_root["index"]
    reach = GEOMETRY.radius_mm + CLAY.tool.radius_mm
    across = np.eye(4)
    across[:3, :3] = np.array(
        [[0, 0, 1], [1, 0, 0], [0, 1, 0]]
    )  # the tool's x along the finger's y
    across[:3, 3] = 80, 0, -reach
    at = Postures("held", turned(0, 0, 0), (root @ across)[None], frozenset({("index", "distal")}))
    deeper = np.eye(4)
    deeper[2, 3] = 0.5
    into = replace(at, tool=(root @ deeper @ across)[None])
    tools = tool_bodies(CLAY)
    mine = [b for b in bodies if b.finger == "index"]
    assert errors(check_meetings(mine, tools, GEOMETRY, at)) == []
    (fault,) = errors(check_meetings(mine, tools, GEOMETRY, into))
    assert fault.part == "index distal_skin and tool"
    assert errors(check_meetings(mine, tools, GEOMETRY, replace(into, touching=frozenset())))


def test_the_tools_mesh_is_its_cylinder():
    mesh = tool_mesh(CLAY.tool, 0.0)
    assert mesh.is_watertight
    assert mesh.bounds[:, 0].tolist() == [CLAY.tool.back_mm, CLAY.tool.tip_mm]
    assert mesh.volume == pytest.approx(np.pi * 36 * 160, rel=2e-3)


def test_a_finger_that_curls_is_told_what_stops_it(bodies):
    some = [b for b in bodies if b.finger in (None, "middle", "ring")]
    figure, *warnings = check_reach(some, GEOMETRY, CLAY.hand, "middle")
    assert 0 < figure.value < 100 and figure.unit == "%"
    assert {w.severity for w in warnings} == {Severity.WARNING}
    assert any("ring" in w.part for w in warnings)
