"""Evaluating a hand: paths, metrics, the return to contact, and what the joints must give."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fpcad.errors import MakeError
from fpcad.model.equilibrium import least_torque
from fpcad.model.statics import cone_facets
from fpcad.solve.attempt import Workbench
from fpcad.spec.catalogue import motor
from fpcad.wield.demand import torque_demand
from fpcad.wield.evaluate import contact_projector, evaluate, motion_range
from fpcad.wield.metrics import path_metrics

POSES = ("carve", "poke", "press")


@pytest.mark.parametrize("pose", POSES)
def test_a_path_passes_the_pose_at_angle_zero(wielding, pose: str):
    path, y = wielding[pose].path, wielding[pose].pose
    at_pose = int(np.searchsorted(path.tool_angle_rad, 0.0))
    assert path.tool_angle_rad[at_pose] == 0
    assert np.array_equal(path.joints_rad[at_pose].ravel(), y[6:18])
    assert np.array_equal(path.contacts[at_pose].ravel(), y[18:])
    assert np.array_equal(path.hand_in_tool, y[:6])


@pytest.mark.parametrize("pose", POSES)
def test_tool_angles_increase_by_at_most_a_step(wielding, pose: str):
    steps = np.diff(wielding[pose].path.tool_angle_rad)
    assert steps.min() > 0 and steps.max() <= wielding[pose].stepping.step * (1 + 1e-9)


@pytest.mark.parametrize("pose", POSES)
def test_evaluation_is_the_joined_traces_and_their_metrics(
    bench: Workbench, first_hand, wielding, pose: str
):
    at = wielding[pose]
    found = evaluate(bench, first_hand.design, {pose: first_hand.states[pose]})
    assert np.array_equal(found.paths[pose].joints_rad, at.path.joints_rad)
    expected = path_metrics(at.path, at.traces[-1.0], at.traces[1.0], at.stepping.step)
    assert found.metrics[pose] == expected
    assert motion_range(bench, pose, first_hand.design, first_hand.states[pose]) == expected.tmr_deg


@pytest.mark.parametrize("pose", POSES)
def test_the_first_hand_wields_its_tool(wielding, pose: str):
    at = wielding[pose]
    metrics = path_metrics(at.path, at.traces[-1.0], at.traces[1.0], at.stepping.step)
    assert metrics.tmr_deg > 20
    assert metrics.mft_p90_nmm <= metrics.mft_nmm <= at.load.max_joint_torque_nmm
    assert 0 <= metrics.mss_mm_s < 20
    assert 0 < metrics.tip_force_n < 10


def test_the_backends_trace_the_same_path(bench: Workbench, first_hand):
    """OSQP, the slow cross-check, along the first degrees of pressing."""
    ranges = {}
    for qp in ("daqp", "osqp"):
        path = bench.spec.path.model_copy(update={"qp": qp, "max_turn_deg": 5.0})
        at = replace(bench, spec=bench.spec.model_copy(update={"path": path}))
        ranges[qp] = evaluate(at, first_hand.design, {"press": first_hand.states["press"]}).paths[
            "press"
        ]
    assert np.allclose(ranges["daqp"].tool_angle_rad, ranges["osqp"].tool_angle_rad)
    assert np.abs(ranges["daqp"].joints_rad - ranges["osqp"].joints_rad).max() < 1e-5


class TestReturnToContact:
    @pytest.mark.parametrize("pose", POSES)
    def test_keeps_the_path_itself(self, bench: Workbench, first_hand, wielding, pose: str):
        path = wielding[pose].path
        to_contact = contact_projector(bench, first_hand.design, path)
        for angle, joints in list(zip(path.tool_angle_rad, path.joints_rad, strict=True))[::9]:
            assert np.abs(to_contact(angle, joints.ravel()) - joints.ravel()).max() < 1e-7

    @pytest.mark.parametrize("pose", POSES)
    def test_corrects_a_guess_between_states_a_little(
        self, bench: Workbench, first_hand, wielding, pose: str
    ):
        path = wielding[pose].path
        to_contact = contact_projector(bench, first_hand.design, path)
        angle = (path.tool_angle_rad[3] + path.tool_angle_rad[4]) / 2
        guess = (path.joints_rad[3] + path.joints_rad[4]).ravel() / 2
        correction = np.abs(to_contact(angle, guess) - guess).max()
        assert 0 < correction < 1e-2

    def test_tells_where_there_is_no_contact(self, bench: Workbench, first_hand, wielding):
        to_contact = contact_projector(bench, first_hand.design, wielding["press"].path)
        with pytest.raises(MakeError, match=r"press: no contact at a tool angle of 1\.5708 rad"):
            to_contact(np.pi / 2, wielding["press"].pose[6:18])


class TestDemand:
    @pytest.mark.parametrize("pose", POSES)
    def test_is_that_of_the_spec_and_the_path(
        self, bench: Workbench, first_hand, wielding, pose: str
    ):
        path = wielding[pose].path
        demand = torque_demand(bench, pose, first_hand.design, path)
        assert demand.tip_force_n == bench.spec.poses[pose].tip_force_n == 10
        assert demand.held_tip_force_n == path.tip_force_n.min()
        assert demand.path_torque_nm == pytest.approx(path.torque_nmm.max() / 1000)
        assert demand.continuous_torque_nm == motor("STS3215-12V").continuous_torque_nm

    @pytest.mark.parametrize("pose", POSES)
    def test_joints_give_the_equilibrium_with_the_least_torque(
        self, bench: Workbench, first_hand, wielding, pose: str
    ):
        """Worst of both directions and of all fingers; motors carry it through the transmission."""
        y, design = first_hand.states[pose], first_hand.design
        demand = torque_demand(bench, pose, design, wielding[pose].path)
        values = bench.kernels[pose].statics(design, y[:6], 0.0, y[6:])
        wrench, torque, tip = (value.copy() for value in values)
        both, facets = [], cone_facets(bench.spec.statics)
        for sign in (1.0, -1.0):
            held = least_torque(wrench, torque, sign * 10 * tip, 10_000, facets)
            assert held is not None
            both.append(held.torque_nmm.reshape(4, 3))
        worst = np.abs(both).max(axis=(0, 1)) / 1000
        assert list(demand.joint_torque_nm.values()) == pytest.approx(worst.tolist())
        assert list(demand.joint_torque_nm) == ["mcp_flex", "mcp_abd", "ip_flex"]
        # Clay's rows of A are [1, 12/13, 0], [1, -12/13, 0], [6/13, 0, 8/13]; tau_q = A' tau_m.
        A = np.array([[13, 12, 0], [13, -12, 0], [6, 0, 8]]) / 13
        at_motors = [np.linalg.solve(A.T, finger) for fingers in both for finger in fingers]
        assert demand.motor_torque_nm == pytest.approx(np.abs(at_motors).max() / 1000)

    def test_a_joint_alone_gets_what_its_motors_add_up_to(
        self, bench: Workbench, first_hand, wielding
    ):
        """Two motors share the differential's flexion and abduction; the IP joint has its own."""
        given = torque_demand(
            bench, "carve", first_hand.design, wielding["carve"].path
        ).motor_joint_torque_nm
        assert given == pytest.approx(
            {"mcp_flex": 1.8, "mcp_abd": 1.8 * 12 / 13, "ip_flex": 0.9 * 8 / 13}
        )

    def test_becomes_plain_json(self, bench: Workbench, first_hand, wielding):
        demand = torque_demand(bench, "carve", first_hand.design, wielding["carve"].path)
        values = demand.to_json()
        assert values["tip_force_n"] == 10 and set(values["joint_torque_nm"]) == {
            "mcp_flex",
            "mcp_abd",
            "ip_flex",
        }
