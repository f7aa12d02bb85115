"""Forces in a finger against balance of the whole finger, virtual work and closed forms."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq

from fpcad.make.loads.finger import FingerForces, Touched, finger_forces, hub_places
from fpcad.make.loads.frames import STRANDS, motor_pulls
from fpcad.make.loads.strands import PRETENSION_N, loop, slack_from_nmm, tensions, transfer
from fpcad.make.loads.supports import Y, Z, beam_moment, on_axis
from fpcad.make.parts.dimensions import finger_dimensions
from fpcad.make.parts.tendon_paths import motor_turns
from fpcad.model.geometry import link_poses
from fpcad.model.transmission import finger_transmission, motor_torques
from tests.make.hands import CENTRE, CLAY, TEMPLATE, design, geometry_of

Array = NDArray[np.float64]

GEOMETRY = geometry_of(CENTRE)
D = finger_dimensions(CLAY, GEOMETRY)
ROUTING = CLAY.motors.transmission
A = finger_transmission(ROUTING)
SPOOL = ROUTING.spool_radius_mm
FINGERS = ("thumb", "index")
STATES = 12


def place(finger: str, link: str, joints: Array, local: Array) -> Array:
    """Where a point (3,) of a link is in H, by the model's own kinematics."""
    number = GEOMETRY.fingers.index(finger)
    whole = np.zeros((len(GEOMETRY.fingers), 3))
    whole[number] = joints
    pose = link_poses(TEMPLATE, design(CENTRE), whole)[finger][link]
    return pose[:3, :3] @ local + pose[:3, 3]


@cache
def touched(finger: str, link: str, abduction: float, seed: int = 3) -> tuple[Touched, Array]:
    """Random contacts of a finger, and the motor torques (K, 3) that virtual work asks for.

    The Jacobian is a central difference of the model's kinematics.
    """
    random = np.random.default_rng(seed)
    low, high = np.array([D.mcp_flex, (-abduction, abduction), D.ip_flex]).T
    joints, points, forces, torques = [], [], [], []
    for _ in range(STATES):
        u = random.uniform(low, high)
        local = np.array([random.uniform(15.0, 35.0), *random.uniform(-8.0, 8.0, 2)])
        push = random.uniform(-20.0, 20.0, 3)
        nudges = 1e-5 * np.eye(3)
        jacobian = [
            place(finger, link, u + n, local) - place(finger, link, u - n, local) for n in nudges
        ]
        joints.append(u)
        points.append(place(finger, link, u, local))
        forces.append(push)
        torques.append(-np.array(jacobian) @ push / 2e-5)  # the finger pushes back
    found = Touched(*map(np.array, (joints, points, forces)), on_distal=link == "distal")
    return found, motor_torques(A, np.array(torques))


def forces_of(finger: str, held: Touched, motors: Array) -> FingerForces:
    return finger_forces(D, GEOMETRY.T_palm_root[finger], held, tensions(motors, SPOOL))


def whole_finger(finger: str, held: Touched, found: FingerForces) -> tuple[Array, Array]:
    """Force and moment (K, 3) about the root that the palm's ears must give, from outside alone.

    Contact and the six strands where they leave their pulleys: nothing of the finger's inside.
    """
    pulls = motor_pulls(D, GEOMETRY.T_palm_root[finger], held.joints_rad[:, 0])
    force, moment = found.contact.copy(), np.cross(found.contact_at, found.contact)
    for k, name in enumerate(STRANDS):
        pulled = (found.tensions.flexor, found.tensions.extensor)[k % 2][:, k // 2, None]
        force += pulled * pulls[name].direction
        moment += pulled * np.cross(pulls[name].at, pulls[name].direction)
    return -force, -moment


@pytest.mark.parametrize("finger", FINGERS)
@pytest.mark.parametrize("link", ["distal", "proximal"])
def test_ears_hold_what_pulls_and_pushes_on_the_whole_finger(finger: str, link: str):
    held, motors = touched(finger, link, D.widest_abduction)
    found = forces_of(finger, held, motors)
    force, moment = whole_finger(finger, held, found)
    np.testing.assert_allclose(found.ears.sum(axis=1), force, atol=1e-9)
    ear = D.mcp.ear_inner + D.mcp.axle_seat / 2
    levers = np.array([[0.0, -ear, 0.0], [0.0, ear, 0.0]])
    given = np.cross(levers, found.ears).sum(axis=1)
    size = np.abs(moment).max()
    np.testing.assert_allclose(given[:, [0, 2]], moment[:, [0, 2]], atol=1e-9 * size)


@pytest.mark.parametrize("finger", FINGERS)
@pytest.mark.parametrize("link", ["distal", "proximal"])
def test_no_free_joint_is_left_with_a_moment(finger: str, link: str):
    """Torques of virtual work leave nothing about the three axes, however they were found."""
    held, motors = touched(finger, link, abduction=1e-9)
    found = forces_of(finger, held, motors)
    assert np.abs(found.unbalanced).max() < 1e-5 * np.abs(motors).max()


def test_abducted_ip_strands_leave_little_about_the_flexion_axis():
    """They turn a corner at the drum, whose lip takes up the rest: T r (1 - cos u2)."""
    held, motors = touched("index", "distal", D.widest_abduction)
    found = forces_of("index", held, motors)
    sine = np.abs(np.sin(held.joints_rad[:, 1]))
    pull = np.abs(found.tensions.ip_flexor - found.tensions.ip_extensor)
    both = found.tensions.ip_flexor + found.tensions.ip_extensor
    corner = pull * D.mcp.drum_radius * (1 - np.cos(held.joints_rad[:, 1]))
    assert np.abs(found.unbalanced[:, 0]).max() < 1e-5 * np.abs(motors).max()
    assert np.all(np.abs(found.unbalanced[:, 1]) <= 0.06 * both * sine + 0.1)
    np.testing.assert_allclose(np.abs(found.unbalanced[:, 2]), corner, atol=0.02 * both.max())


def test_each_link_is_in_balance():
    """Distal and proximal bone cut free, moments about another point than the code's."""
    held, motors = touched("index", "distal", abduction=1e-9)
    found = forces_of("index", held, motors)
    low, high = hub_places(D)
    total = -found.ip_force + found.hubs.sum(axis=1)
    total[:, 2] += found.hub_thrust
    total[:, 0] -= found.tensions.palmar.sum(axis=1)
    np.testing.assert_allclose(total, 0.0, atol=1e-5)
    about = np.array([D.proximal_length, 0.0, 0.0])
    m = D.mcp
    hubs, thrust = found.hubs, np.zeros_like(total)
    thrust[:, 2] = found.hub_thrust
    moment = -found.ip_moment + np.cross(-about, thrust)
    moment += np.cross([0, 0, low] - about, hubs[:, 0]) + np.cross([0, 0, high] - about, hubs[:, 1])
    for k, side in enumerate((1, -1)):
        pull = np.zeros_like(total)
        pull[:, 0] = -found.tensions.palmar[:, k]
        moment += np.cross([0, side * m.output_radius, -m.input_radius] - about, pull)
    np.testing.assert_allclose(moment, 0.0, atol=1e-4)


def test_one_force_across_a_straight_finger_in_closed_form():
    """10 N on the palmar side, 20 mm beyond the IP axis."""
    push, lever = 10.0, 20.0
    joints = np.zeros((1, 3))
    point = place("index", "distal", joints[0], np.array([lever, 0.0, 0.0]))
    up = GEOMETRY.T_palm_root["index"][:3, 2]
    held = Touched(joints, point[None], push * up[None], on_distal=True)
    ip, flexion = push * lever, push * (lever + D.proximal_length)
    motors = motor_torques(A, np.array([[flexion, 0.0, ip]]))
    found = forces_of("index", held, motors)
    flexor, extensor = loop(np.array([ip / D.ip_pulley]), PRETENSION_N)
    t = found.tensions
    assert t.ip_flexor == pytest.approx(flexor) and t.ip_extensor == pytest.approx(extensor)
    # nearly along the finger: strands lean by (4 - 3) / 57.5
    assert found.ip_force[0, 0] == pytest.approx(float(flexor[0] + extensor[0]), rel=1e-3)
    assert found.ip_force[0, 2] == pytest.approx(-push, abs=0.02 * float(flexor[0]))
    assert found.unbalanced == pytest.approx(0.0, abs=1e-6)
    each = (flexion - ip * D.mcp.drum_radius / D.ip_pulley) / 2 / D.mcp.input_radius
    assert t.palmar[0] - t.dorsal[0] == pytest.approx(each)


def test_strands_do_as_much_work_as_the_contact():
    """Tension times what the parts' own strands travel is force times what the contact moves."""
    u, nudge = np.array([0.4, 0.0, 0.6]), 1e-4
    local, push = np.array([25.0, 0.0, -6.0]), np.array([3.0, 0.0, 8.0])
    root = GEOMETRY.T_palm_root["index"]
    for step in nudge * np.eye(3)[[0, 2]]:
        moved = place("index", "distal", u + step, local) - place(
            "index", "distal", u - step, local
        )
        turned = motor_turns(D, root, SPOOL, u + step) - motor_turns(D, root, SPOOL, u - step)
        jacobian = [
            place("index", "distal", u + n, local) - place("index", "distal", u - n, local)
            for n in nudge * np.eye(3)
        ]
        motors = motor_torques(A, -np.array(jacobian) @ push / (2 * nudge))
        t = tensions(motors[None], SPOOL)
        shortened = turned * SPOOL
        strands = (t.flexor - t.extensor)[0] @ shortened
        assert strands == pytest.approx(-push @ moved, rel=2e-3)


@pytest.mark.parametrize("pull", [-200.0, -10.0, 0.0, 12.0, 80.0])
def test_a_loop_holds_its_pull_and_its_pretension(pull: float):
    tight, other = loop(np.array(pull), PRETENSION_N)
    assert tight - other == pytest.approx(pull) and min(tight, other) >= 0
    if abs(pull) <= 2 * PRETENSION_N:
        assert tight + other == pytest.approx(2 * PRETENSION_N)
    else:
        assert min(tight, other) == 0
    assert slack_from_nmm(6.5) == pytest.approx(2 * PRETENSION_N * 6.5)


@pytest.mark.parametrize(
    "pulls", [(0.0, 0.0), (10.0, -6.0), (8.0, 20.0), (90.0, 80.0), (-70.0, 5.0)]
)
def test_transfer_strands_are_what_springs_of_their_lengths_hold(pulls: tuple[float, float]):
    """The same three strands as springs that only pull, the dorsal one twice as long, by root finding."""

    def stretch(dorsal: float) -> float:
        """What the strands stretch in all, which pulleys and output cannot change [mm]."""
        each = [(dorsal + pull - PRETENSION_N) / 50.0 for pull in pulls]
        return sum(each) + (dorsal - PRETENSION_N) / 25.0

    alone = brentq(stretch, -500.0, 500.0)
    expected = max(alone, *(-pull for pull in pulls), 0.0)  # none can push
    palmar, dorsal = transfer(np.array(pulls[:1]), np.array(pulls[1:]), PRETENSION_N)
    assert dorsal[0] == pytest.approx(expected)
    assert palmar[0] == pytest.approx(np.array(pulls) + expected)
    assert min(*palmar[0], dorsal[0]) >= 0.0


def test_supports_share_a_force_by_its_levers():
    force, moment = np.array([[0.0, 0.0, 9.0]]), np.array([[9.0 * 2.0, 0.0, 0.0]])  # 9 N at y = 2
    low, high = on_axis(force, moment, Y, (-1.0, 3.0))[0]
    assert low == pytest.approx([0, 0, 9 / 4]) and high == pytest.approx([0, 0, 27 / 4])
    about_z = on_axis(np.array([[4.0, 0.0, 5.0]]), np.array([[0.0, 4.0, 7.0]]), Z, (-1.0, 1.0))[0]
    assert about_z == pytest.approx(np.array([[0, 0, 0], [4, 0, 0]]))


def test_a_beam_on_two_supports_bends_by_f_l_over_4():
    places = np.array([5.0, -5.0, 0.0])  # in any order
    forces = np.array([[[0, 0, -3.0], [0, 0, -3.0], [0, 0, 6.0]]])
    assert beam_moment(places, forces)[0] == pytest.approx(6.0 * 10.0 / 4)
