"""Loads of a finished hand, read from its files, against what other code says of the same."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fpcad.make.gates.finding import Severity
from fpcad.make.loads.cases import GRIPPING, MOST, WITH_TIP, Case, grip_cases
from fpcad.make.loads.check import load_findings
from fpcad.make.loads.motors import spool_torques, tip_load, torque_load
from fpcad.make.loads.table import Load, loads_csv
from fpcad.make.trajectory import Trajectory
from fpcad.make.trajectory_file import read_trajectory
from fpcad.model.geometry import HandGeometry
from fpcad.pipeline.finished import finished_hand
from fpcad.spec.schema import Spec
from fpcad.store import read_json
from fpcad.units import M_PER_MM, NM_PER_NMM

POSES = ("carve", "poke", "press")
Built = tuple[Path, Spec, HandGeometry]


@pytest.fixture(scope="module")
def built(built_clay: Path) -> Built:
    return built_clay, *finished_hand(built_clay)


@pytest.fixture(scope="module", params=POSES)
def held(request, built: Built) -> tuple[Trajectory, dict[str, Case]]:
    folder, spec, geometry = built
    trajectory = read_trajectory(folder / "trajectories" / f"{request.param}.json")
    cases = grip_cases(spec, geometry, request.param, trajectory)
    return trajectory, {case.name: case for case in cases}


def weight_n(spec: Spec) -> np.ndarray:
    down = np.array(spec.grip.gravity) / np.linalg.norm(spec.grip.gravity)
    return 9.81e-3 * spec.grip.tool_mass_g * down


def test_forces_on_the_tool_balance(built: Built, held):
    """Forces and moments, the tip's force from the file's own poses of the tool."""
    _, spec, _ = built
    trajectory, cases = held
    first = {angle: k for k, angle in enumerate(trajectory.tool.angle_rad)}
    for case in cases.values():
        rows = [first[angle] for angle in case.angle_rad]
        poses = trajectory.tool.pose_palm[rows]
        tip, centre, across = _tool(poses, trajectory)
        missing = case.forces_n.sum(axis=1)
        if case.name != MOST:
            missing = missing + weight_n(spec)
        turning = np.cross(case.points_mm - centre[:, None], case.forces_n).sum(axis=1)
        size = np.linalg.norm(missing, axis=1)
        np.testing.assert_allclose(size, case.tip_force_n, atol=0.02)
        if case.name != GRIPPING:
            np.testing.assert_allclose(
                np.abs(np.einsum("ki,ki->k", missing, across)), case.tip_force_n, atol=0.02
            )
            lever = np.cross(tip - centre, missing)
            np.testing.assert_allclose(turning, lever, atol=2.0)  # N mm, of 80 mm


def _tool(poses: np.ndarray, trajectory: Trajectory) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Tip and centre [mm] of the tool, and the direction in which its tip is turned."""
    turned = Rotation.from_quat(poses[:, 3:], scalar_first=True)
    origin, along = poses[:, :3] / M_PER_MM, turned.apply([1.0, 0.0, 0.0])
    tool = trajectory.tool
    middle = (tool.back_m + tool.tip_m) / 2 / M_PER_MM
    return (
        origin + tool.tip_m / M_PER_MM * along,
        origin + middle * along,
        turned.apply([0, 1.0, 0]),
    )


def test_the_greatest_tip_force_is_what_selection_was_told(built: Built, held):
    folder, spec, _ = built
    case = held[1][MOST]
    told = read_json(folder / "selected.json")["torque"][case.pose]
    found = tip_load(spec, case)
    assert found.limit == pytest.approx(told["held_tip_force_n"], rel=2e-3)
    assert found.load == told["tip_force_n"]
    torque = np.abs(spool_torques(spec, case)).max() * NM_PER_NMM
    assert torque == pytest.approx(told["continuous_torque_nm"], rel=1e-3)


def test_gripping_takes_the_motors_share_that_grip_json_tells(built: Built, held):
    folder, spec, _ = built
    case = held[1][GRIPPING]
    share = read_json(folder / "grip.json")[case.pose]["motor_share"]
    assert torque_load(spec, case).share == pytest.approx(share, rel=1e-6)


def test_a_newton_at_the_tip_lies_about_the_grip_evenly(held):
    """Its two directions change forces and torques alike, one up and one down."""
    gripping, with_tip = held[1][GRIPPING], held[1][WITH_TIP]
    plus, minus = np.split(with_tip.torque_nmm, 2)
    np.testing.assert_allclose((plus + minus) / 2, gripping.torque_nmm, atol=1e-6)
    assert np.abs(plus - minus).max() > 1.0


def test_the_build_has_a_table_and_findings(built: Built):
    folder, spec, _ = built
    rows = list(csv.DictReader((folder / "parts" / "loads.csv").open(encoding="utf-8")))
    assert {row["pose"] for row in rows} == {*spec.poses, "any"}
    kinds = {"motor torque", "motor speed", "motor turn", "spool turn", "tip force", "strand"}
    assert {row["what"] for row in rows} >= {
        *kinds,
        "bearing",
        "pin pressure",
        "pin bending",
        "bone",
    }
    for row in rows:
        share = float(row["load"]) / float(row["limit"])
        assert float(row["share"]) == pytest.approx(share, rel=2e-3, abs=1e-3)
    checks = list(csv.DictReader((folder / "parts" / "checks.csv").open(encoding="utf-8")))
    found = [row for row in checks if row["gate"] == "load"]
    assert {row["severity"] for row in found} == {"warning", "figure"}
    assert any("are asked for at the tip" in row["text"] for row in found)


def test_a_weak_motor_is_told_with_figures():
    loads = [
        Load("press", "gripping", "motor torque", "index_m3 (small)", 1.31, 0.9, "N m", 12.2),
        Load("carve", "gripping", "motor torque", "index_m1 (small)", 0.5, 0.9, "N m", 3.0),
        Load("carve", "moving", "motor speed", "index_m1 (small)", 1.0, 4.0, "rad/s"),
    ]
    weak, fast = load_findings(loads)
    assert weak.severity is Severity.WARNING and fast.severity is Severity.FIGURE
    assert str(weak) == (
        "index_m3 (small): cannot: needs 1.31 N m in press, gripping, tool turned 12 deg, gives 0.9 N m"
    )
    assert "limit 4 rad/s (25 %)" in fast.text
    assert "press,gripping,motor torque,index_m3 (small),1.31,0.9,N m,1.456,12.2" in loads_csv(
        loads
    )


def test_what_is_too_much_at_most_tells_its_share_while_gripping():
    loads = [
        Load("carve", GRIPPING, "bearing", "thumb IP ball MR74", 53.5, 107.0, "N", 1.0),
        Load("poke", MOST, "bearing", "index IP ball MR74", 160.5, 107.0, "N", 5.0),
    ]
    (told,) = load_findings(loads)
    assert told.severity is Severity.WARNING and told.part == "index IP ball MR74"
    assert told.text.endswith("limit 107 N (150 %); gripping alone 50 %")
