"""Montana's rates against the constraint that they solve, differentiated without them."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from fpcad.model.contact import contact_residual, contact_rows, opposition
from fpcad.model.frames import Frame, rot_x
from fpcad.model.hand import LinkShape
from fpcad.model.surfaces import SurfacePoint, capsule_point, cylinder_point
from fpcad.solve.attempt import Workbench
from fpcad.spec.tool import CylinderTool
from tests.model.plain_hand import Array, Posture
from tests.model.postures import touching_posture

POSES = ("carve", "poke", "press")
STEP = 1e-6
PLACES_MM = {
    "cylinder": -12.0,
    "tip": 5.0,
    "just before the seam": -1e-8,
    "just behind the seam": 1e-8,
}


def rates(bench: Workbench, pose: str, at: Posture, i: int) -> tuple[Array, Array]:
    """Joint rates that neither lift nor press contact `i` at tool rate 1, and its contact rates."""
    _, _, N, n0, C, c0, *_ = bench.kernels[pose].rates(at.d, at.h, at.turn, at.x)
    u_rate = np.random.default_rng(i).normal(size=12)
    u_rate -= N[i] * (N[i] @ u_rate + n0[i]) / (N[i] @ N[i])
    return u_rate, (C @ u_rate + c0)[4 * i : 4 * i + 4]


def implicit_rates(
    bench: Workbench, pose: str, at: Posture, i: int, u_rate: Array
) -> tuple[Array, float]:
    """Contact rates (4,) that keep the rows at zero, and what remains of the five equations.

    rows(u, a, turn) = 0 gives rows_a da = -(rows_u du + rows_turn).
    """
    _, _, rows, J, *_ = bench.kernels[pose].constraints(at.d, at.turn, at.y)
    assert np.abs(rows[5 * i : 5 * i + 5]).max() < 1e-12
    J = J[5 * i : 5 * i + 5]
    drift = J[:, 6:18] @ u_rate + J[:, -1]
    own = J[:, 18 + 4 * i : 22 + 4 * i]
    a_rate: Array = np.linalg.lstsq(own, -drift, rcond=None)[0].astype(np.float64)
    return a_rate, float(np.abs(own @ a_rate + drift).max())


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("place", PLACES_MM)
@pytest.mark.parametrize("pose", POSES)
def test_montana_is_the_constraint_differentiated(
    bench: Workbench, pose: str, place: str, seed: int
):
    for i in range(len(bench.spec.poses[pose].contacts)):
        at = touching_posture(bench.spec, pose, i, PLACES_MM[place], seed)
        u_rate, a_rate = rates(bench, pose, at, i)
        expected, left = implicit_rates(bench, pose, at, i, u_rate)
        assert left < 1e-10  # five equations, four rates: consistent, for contact is kept
        assert np.allclose(a_rate, expected, atol=1e-8, rtol=1e-8)


@pytest.mark.parametrize("pose", POSES)
def test_contact_rates_jump_at_the_seam(bench: Workbench, pose: str):
    """The fingertip curves along the finger, the cylinder does not; the joint rates are the same."""
    before, behind = (touching_posture(bench.spec, pose, 0, side, 5) for side in (-1e-8, 1e-8))
    (u_before, a_before), (u_behind, a_behind) = (
        rates(bench, pose, at, 0) for at in (before, behind)
    )
    assert np.allclose(u_before, u_behind, atol=1e-6)
    assert np.abs(a_before - a_behind).max() > 0.1


@pytest.mark.parametrize("seed", range(3))
def test_contact_is_kept_to_second_order(bench: Workbench, seed: int):
    """Half the step leaves a quarter of the gap."""
    at = touching_posture(bench.spec, "carve", 1, 4.0, seed)
    u_rate, a_rate = rates(bench, "carve", at, 1)
    gaps = []
    for time in (1e-4, 5e-5):
        a = at.a.copy()
        a[1] += time * a_rate
        moved = at._replace(turn=at.turn + time, u=at.u + time * u_rate.reshape(4, 3), a=a)
        gaps.append(np.linalg.norm(moved.tool(1).p - moved.finger(1).p))
    assert gaps[0] / gaps[1] == pytest.approx(4, rel=1e-2)


def crossed(angle: float) -> tuple[SurfacePoint, SurfacePoint]:
    """Tool and finger touching with their axes at an angle; the tool's normal is +y."""
    tool = cylinder_point(CylinderTool(radius_mm=6, back_mm=-80, tip_mm=80), 0, 0)
    shape = LinkShape(34.5, 8.0, True, True, False, 0.0)
    finger = capsule_point(shape, 10, 0).moved(Frame(rot_x(np.pi / 2), ca.DM.zeros(3)))
    turn = ca.DM([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
    finger = finger.moved(Frame(turn, ca.DM.zeros(3)))
    if float(ca.dot(finger.normal, tool.normal)) > 0:
        finger = finger.moved(Frame(rot_x(np.pi), ca.DM.zeros(3)))
    return tool, finger.moved(Frame(ca.DM.eye(3), tool.p - finger.p))


def test_residual_and_rows_vanish_in_contact():
    tool, finger = crossed(0.5)
    assert np.abs(np.array(contact_residual(tool, finger))).max() < 1e-14
    assert np.abs(np.array(contact_rows(tool, finger))).max() < 1e-13
    assert float(opposition(tool, finger)) == pytest.approx(1)


def test_rows_vanish_on_the_wrong_branch_too_and_opposition_tells():
    tool, finger = crossed(0.5)
    inside = finger._replace(normal=-finger.normal)
    assert np.abs(np.array(contact_rows(tool, inside))).max() < 1e-13
    assert np.abs(np.array(contact_residual(tool, inside))).max() == pytest.approx(2)
    assert float(opposition(tool, inside)) == pytest.approx(-1)


def test_five_rows_are_independent_where_six_are_not(bench: Workbench):
    """At a contact the six equations' Jacobian has rank five, in all of the contact's variables."""
    at = touching_posture(bench.spec, "press", 0, -10.0, 0)
    kernels = bench.kernels["press"]
    six = np.stack(
        [
            (
                kernels.residual(at.d, at.turn, at.y + step)[0][:6].copy()
                - kernels.residual(at.d, at.turn, at.y - step)[0][:6].copy()
            )
            / (2 * STEP)
            for step in STEP * np.eye(len(at.y))
        ],
        axis=1,
    )
    assert np.linalg.matrix_rank(six, tol=1e-5) == 5
    five = kernels.constraints(at.d, at.turn, at.y)[3][:5]
    assert np.linalg.matrix_rank(five, tol=1e-5) == 5
