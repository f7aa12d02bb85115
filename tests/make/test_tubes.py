"""Tubes are smooth, keep clear of the flange, and lead every strand to its motor; tendons run through them."""

from __future__ import annotations

import math
from itertools import permutations

import numpy as np
import pytest

from fpcad.make.gates.finding import Severity
from fpcad.make.gates.tubes import LEAST_BEND_MM, check_tubes
from fpcad.make.parts.curves import dense, hermite, length_of, swept
from fpcad.make.parts.dimensions import finger_dimensions
from fpcad.make.parts.mounting import motor_names, mounting
from fpcad.make.parts.tendon_lengths import TAIL_MM, pieces_to_cut, tendon_lengths
from fpcad.make.parts.tube_routes import flange_gap, tube_ends
from tests.make.hands import CENTRE, CLAY, CORNERS, geometry_of
from tests.make.test_flange import with_mount

GEOMETRY = geometry_of(CENTRE)
D = finger_dimensions(CLAY, GEOMETRY)
MOUNT = mounting(CLAY, GEOMETRY, D)


def test_a_hermite_curve_bends_as_its_points_do():
    start, end = np.zeros(3), np.array([30.0, 5.0, 60.0])
    points, curvature = hermite(start, end, np.array([0, 0, 80.0]), np.array([10.0, 0, 70.0]))
    assert points[0] == pytest.approx(start) and points[-1] == pytest.approx(end)
    for i in (10, 24, 40):
        a, b, c = points[i - 1], points[i], points[i + 1]
        sides = [np.linalg.norm(p - q) for p, q in ((b, a), (c, b), (c, a))]
        circle = 2 * np.linalg.norm(np.cross(b - a, c - a)) / math.prod(sides)  # 1 / radius
        assert curvature[i] == pytest.approx(circle, rel=2e-2)


def test_a_swept_rod_is_a_closed_prism():
    line = np.array([[0.0, 0, 0], [0, 0, 10.0], [0, 0, 20.0]])
    rod = swept(line, 1.0)
    assert rod.is_watertight
    assert rod.volume == pytest.approx(20 * 5 * math.sin(2 * math.pi / 10), rel=1e-9)
    assert length_of(dense(line)) == pytest.approx(20)
    assert np.linalg.norm(np.diff(dense(line), axis=0), axis=1).max() <= 0.5 + 1e-9


@pytest.mark.parametrize("values", [CENTRE, *CORNERS], ids=str)
def test_tubes_bend_gently_and_keep_clear_of_the_flange(values):
    bend, gap, crossing = check_tubes(CLAY, geometry_of(values))
    assert bend.value > LEAST_BEND_MM and gap.value > 1.0
    assert {bend.severity, gap.severity, crossing.severity} == {Severity.FIGURE}


def test_every_tube_leads_from_its_exit_to_its_port():
    ends = {end.strand: end for end in tube_ends(GEOMETRY, D)}
    assert list(MOUNT.route) == list(ends) and len(ends) == 24
    into = MOUNT.tubes.T_palm_box[:3, 2]
    for strand, route in MOUNT.route.items():
        slot, end = MOUNT.slot(strand.rpartition("_")[0]), ends[strand]
        port = slot.flexor_port if strand.endswith("flexor") else slot.extensor_port
        T = MOUNT.tubes.T_palm_box
        assert route.points[-1] == pytest.approx(T[:3, :3] @ port + T[:3, 3])
        assert route.points[0] == pytest.approx(end.start)
        first, last = np.diff(route.points, axis=0)[[0, -1]]
        assert first @ end.ahead > 0.999 * np.linalg.norm(first)
        assert last @ into > 0.99 * np.linalg.norm(last)


def test_each_motor_has_a_place_of_its_own():
    assert list(MOUNT.tubes.slots) == motor_names(GEOMETRY.fingers)
    assert sorted(MOUNT.tubes.slots.values()) == list(range(12))


def test_a_fingers_motors_cannot_change_places_for_shorter_tubes():
    """Lengths of straight lines from exit to port, which the tubes follow closely, are no shorter."""
    ends, T = tube_ends(GEOMETRY, D), MOUNT.tubes.T_palm_box

    def straight(finger, places):
        total = 0.0
        for end in ends:
            name, motor, side = end.strand.split("_")
            if name == finger:
                slot = MOUNT.box.slots[places[int(motor[1]) - 1]]
                port = slot.flexor_port if side == "flexor" else slot.extensor_port
                total += float(np.linalg.norm(T[:3, :3] @ port + T[:3, 3] - end.start))
        return total

    for finger in GEOMETRY.fingers:
        now = [MOUNT.tubes.slots[f"{finger}_m{n}"] for n in (1, 2, 3)]
        best = min(straight(finger, other) for other in permutations(now))
        assert straight(finger, now) <= best + 8.0


def test_the_gap_to_the_flange_is_that_of_its_mesh(clay_parts):
    import trimesh

    rng, f = np.random.default_rng(3), MOUNT.flange
    points = f.T_palm_foot[:3, 3] + rng.uniform((-45, -45, 8), (45, 45, f.stem), (300, 3))
    told = flange_gap(f, points)
    real = -trimesh.proximity.signed_distance(clay_parts["flange"].mesh, points)
    outside = real > 0.1
    assert np.all(
        told[outside] <= real[outside] + 0.1
    )  # slots and screws' heads apart, never too wide
    assert np.median((real - told)[outside]) < 1.0


def test_a_tendon_is_as_long_as_its_pieces():
    for own in tendon_lengths(GEOMETRY, D, MOUNT):
        assert own.shortest <= own.in_hand <= own.longest
        assert own.on_spool > 0 and own.tube == MOUNT.route[own.strand].length_mm
        assert own.total == pytest.approx(own.in_hand + own.tube - 4.5 + own.in_box + own.on_spool)
    pieces = pieces_to_cut(CLAY, GEOMETRY)
    assert len(pieces) == 24 + 4 * 4 and min(pieces) > 2 * TAIL_MM


def test_spools_pay_out_what_pulleys_take_over_the_whole_range():
    """Wrap at the ends of the travel: never less than what holds the knot."""
    from itertools import product

    from fpcad.model.transmission import finger_transmission

    A, spool = finger_transmission(CLAY.motors.transmission), MOUNT.box.spool
    corners = np.array(list(product(D.mcp_flex, D.mcp_abd, D.ip_flex)))
    turns = corners @ A.T
    for own in tendon_lengths(GEOMETRY, D, MOUNT):
        motor = int(own.strand.split("_")[1][1]) - 1
        sign = 1 if own.strand.endswith("flexor") else -1
        assert (own.on_spool / spool.pitch + sign * turns[:, motor]).min() > math.radians(10)


def test_a_box_that_stands_elsewhere_has_tubes_of_the_length_that_the_spec_says():
    spec = with_mount(box=False, tube_mm=700.0)
    mount = mounting(spec, GEOMETRY, D)
    assert {route.length_mm for route in mount.tubes.routes} == {700.0}
    assert {part.link for part in mount.parts()} == {"box"}
    tubes = [item for item in mount.items() if item.kind == "tubes"]
    assert {(item.link, item.length_mm) for item in tubes} == {("palm", 700.0)}
    assert {item.link for item in mount.items() if item.kind == "motors"} == {"box"}
    assert check_tubes(spec, GEOMETRY) == []
