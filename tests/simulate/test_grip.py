"""Clay's first hand in MuJoCo: it presses as planned, holds, slips when it must, and repeats itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fpcad.errors import MakeError
from fpcad.make.preload.plan import grip_preload
from fpcad.simulate.command import commands
from fpcad.simulate.engine import mujoco
from fpcad.simulate.hold import Hold, at_rest, measured
from fpcad.simulate.measure import outcome, tool_angles
from fpcad.simulate.roll import Record
from fpcad.simulate.scene import build_scene
from fpcad.simulate.setting import Trial
from fpcad.simulate.trials import run_trial
from fpcad.spec.pose import Turning
from tests.simulate.grips import Gripping, gripping

POSES = ("carve", "press")
Z = Turning(axis=(0, 0, 1), pivot_mm=(0, 0, 0))


@pytest.fixture(scope="module", params=POSES)
def grip(request) -> Gripping:
    return gripping(request.param)


@pytest.fixture(scope="module")
def record(grip: Gripping) -> Record:
    return grip.run(tool_mass_kg=0.05)


def test_contacts_bear_the_planned_forces(grip: Gripping, record: Record):
    """The tool weighs what the plan says: so forces are those of the plan, without any fitting."""
    m = grip.mechanism
    planned = grip_preload(m.spec, m.grip, m.posture[None], np.zeros(1)).forces_n[0]
    np.testing.assert_allclose(record.normal_n[-1], planned[:, 0], rtol=0.06, atol=0.05)
    tangential = np.hypot(planned[:, 1], planned[:, 2])
    np.testing.assert_allclose(record.tangential_n[-1], tangential, rtol=0.15, atol=0.15)


def test_the_tool_stays_where_it_is_planned(grip: Gripping, record: Record):
    offset = np.linalg.norm(record.tool_pose[:, :3] - record.planned_position_m, axis=1)
    assert offset.max() < 3e-4
    told = outcome(record, grip.trajectory, Z, 0.9)
    assert told.held and told.saturated_share == 0.0 and min(told.contact_share) == 1.0
    assert max(told.slip_mm) < 0.5


def test_motors_bear_the_contacts_torques(grip: Gripping, record: Record):
    m = grip.mechanism
    preload = grip_preload(m.spec, m.grip, m.posture[None], np.zeros(1))
    most = 0.9 * preload.margins.motor_share
    assert np.abs(record.motor_nm[-1]).max() == pytest.approx(most, abs=0.02)


def test_an_equal_trial_ends_in_equal_bytes(grip: Gripping):
    first, second = (grip.run(tip_force_n=0.2) for _ in range(2))
    for name in ("tool_pose", "joints_rad", "motor_nm", "normal_n", "tangential_n", "slip_mm_s"):
        assert getattr(first, name).tobytes() == getattr(second, name).tobytes()


def test_without_friction_the_tool_is_lost(grip: Gripping):
    record = grip.run(friction=0.02, tool_mass_kg=0.1)
    told = outcome(record, grip.trajectory, Z, 0.9)
    assert not told.held and told.lost_at_s is not None


def test_half_the_time_step_ends_in_the_same_place(grip: Gripping, record: Record):
    finer = grip.run(tool_mass_kg=0.05, time_step_s=2.5e-4)
    assert np.abs(finer.tool_pose[-1, :3] - record.tool_pose[-1, :3]).max() < 2e-5


def test_a_simulation_that_falls_apart_is_told_of(grip: Gripping, tmp_path, monkeypatch):
    """MuJoCo by itself would put the tool back into the hand, and write a log where it runs."""
    monkeypatch.chdir(tmp_path)
    with pytest.raises(MakeError, match="unstable while the fingers close"):
        grip.run(tool_mass_kg=1e-5, time_step_s=2e-3)
    assert list(tmp_path.iterdir()) == []


def test_a_trajectory_without_preload_is_refused(grip: Gripping):
    with pytest.raises(MakeError, match="no grip preload"):
        run_trial(grip.hand, grip.mechanism.spec, "", grip.without_preload(), Trial())


def test_a_hold_tells_sag_and_drift(grip: Gripping, record: Record):
    resting = at_rest(grip.trajectory)
    told = measured(record, grip.trajectory, "-z", 0.05, 1.0)
    assert told.held and told.still and told.sag_mm < 0.3 and told.drift_mm < 0.05
    assert resting.duration_s == 10.0
    kept, given = resting.position_preload_rad, grip.trajectory.position_preload_rad
    assert kept is not None and given is not None and np.array_equal(kept, given)
    assert not Hold("-z", 0.02, 1.0, True, 0.0, 0.0, 1.1, 0.0).still


def test_the_skin_is_as_stiff_as_the_spec_says(grip: Gripping, record: Record):
    """Depth of a contact in a settled grip times the skin's stiffness is its force."""
    mj = mujoco()
    scene = build_scene(grip.hand.copy(), grip.mechanism.spec, grip.trajectory, Trial(0.05))
    data = mj.MjData(scene.model)
    told = commands(grip.trajectory, scene.A, Trial(0.05))
    data.qpos[scene.joints] = grip.trajectory.position_rad[0]
    data.qpos[scene.rotors] = scene.A @ grip.trajectory.position_rad[0]
    for target in told.motors_rad[: told.let_go]:  # still held by the giver
        data.ctrl[: len(scene.A)] = target
        mj.mj_step(scene.model, data, 8)
    mj.mj_forward(scene.model, data)
    force = np.zeros(6)
    for index in range(data.ncon):
        contact = data.contact[index]
        if contact.geom1 in scene.contacts or contact.geom2 in scene.contacts:
            mj.mj_contactForce(scene.model, data, index, force)
            assert force[0] == pytest.approx(-contact.dist * 30_000.0, rel=0.03)


def test_what_the_tool_turns_after_it_tipped_does_not_count(grip: Gripping, record: Record):
    """It turns by 0.1 rad in every tick and from the fourth on it lies 40 degrees askew."""
    start = Rotation.from_quat(grip.trajectory.tool.pose_palm[0, 3:], scalar_first=True)
    ticks = np.arange(1, 7)
    tilt = np.radians(np.where(ticks < 4, 5.0, 40.0))
    poses = np.tile(record.tool_pose[-1], (6, 1))
    turned = Rotation.from_euler("ZY", np.column_stack([0.1 * ticks, tilt]))
    poses[:, 3:] = (start * turned).as_quat(scalar_first=True)
    rows = {
        name: getattr(record, name)[-6:]
        for name in ("motor_nm", "normal_n", "slip_mm_s", "planned_position_m")
    }
    tool = replace(grip.trajectory.tool, angle_rad=np.array([-0.05, 0.5]))
    planned = replace(grip.trajectory, tool=tool)
    seen = replace(record, time_s=record.time_s[-6:], tool_pose=poses, **rows)
    told = outcome(seen, planned, Z, 0.9)
    assert told.held and not told.wielded and told.tipped_at_s == record.time_s[-3]
    assert told.reached_deg == pytest.approx(np.degrees(0.3))


def test_tool_angles_are_those_of_its_axis(grip: Gripping, record: Record):
    """A turn about z counts, a tilt is told apart, and spin of the round tool shows nothing."""
    start = Rotation.from_quat(grip.trajectory.tool.pose_palm[0, 3:], scalar_first=True)
    spin = Rotation.from_euler("x", 2.0)
    moved = start * Rotation.from_euler("z", 0.5) * Rotation.from_euler("y", 0.1) * spin
    pose = np.zeros((1, 7))
    pose[0, 3:] = moved.as_quat(scalar_first=True)
    turned, tilt = tool_angles(replace(record, tool_pose=pose), grip.trajectory, Z)
    assert turned[0] == pytest.approx(0.5)
    assert abs(tilt[0]) == pytest.approx(0.1)
