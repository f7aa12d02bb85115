"""The bench stand: jigs hold the tool where it belongs, keep clear of the fingers, and can be drawn away."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fpcad.make.documents.inventory import read_inventory
from fpcad.make.documents.stand_file import read_stand
from fpcad.make.gates.finding import Severity
from fpcad.make.gates.meetings import tool_mesh
from fpcad.make.mesh import INTERFERENCE_MM3, manifold_of
from fpcad.make.parts.assembly import Assembly
from fpcad.make.parts.dimensions import finger_dimensions
from fpcad.make.parts.mounting import mounting
from fpcad.make.stand.gates import GATE
from fpcad.make.stand.jig import rib_width
from fpcad.make.stand.jig_place import AWAY_MM, CLEAR_MM, find_place
from fpcad.make.stand.scene import OPENED_DEG, opened, stand_frame
from fpcad.make.stand.stand import Stand, check_stand, make_stand
from fpcad.make.stand.steps import bench_steps, stand_rows
from fpcad.make.trajectory_file import read_trajectory
from fpcad.pipeline.finished import finished_hand
from fpcad.store import read_json
from tests.make.hands import CLAY
from tests.make.simple_hand import capsule

FLOOR_MM = -95.0


@pytest.fixture(scope="module")
def build(built_clay: Path):
    spec, geometry = finished_hand(built_clay)
    files = sorted((built_clay / "trajectories").glob("*.json"))
    return spec, geometry, {file.stem: read_trajectory(file) for file in files}


@pytest.fixture(scope="module")
def stand(build) -> Stand:
    """The stand of a hand without parts: its capsules are what jigs are placed by."""
    spec, geometry, trajectories = build
    base = mounting(spec, geometry, finger_dimensions(spec, geometry)).T_palm_base
    return make_stand(spec, geometry, Assembly((), ()), base, trajectories)


def solid_tool(scene, less=0.0):
    return manifold_of(tool_mesh(CLAY.tool, less).apply_transform(scene.T_stand_tool))


def test_every_pose_has_a_jig_or_a_warning(stand, build):
    lacking = {
        f.part.removeprefix("jig_")
        for f in stand.findings
        if f.gate == "jig" and f.severity is Severity.WARNING
    }
    assert set(stand.jigs) | lacking >= set(build[2])
    assert len(stand.jigs) >= 2


def test_the_stand_fits_the_bed(stand):
    assert not [f for f in stand.findings if "does not fit" in f.text]
    assert [part.name for part in stand.bench] == ["bench_stand", "bench_front"]


def test_a_jig_touches_the_tool(stand):
    for pose, jig in stand.jigs.items():
        scene, body = stand.scenes[pose], manifold_of(jig.mesh)
        assert 0 < body.min_gap(solid_tool(scene), 1.0) < 0.05


def test_a_jig_keeps_clear_of_the_fingers(stand):
    for pose, jig in stand.jigs.items():
        body, hand = manifold_of(jig.mesh), stand.scenes[pose].obstacles
        for start, end, radius in zip(hand.starts, hand.ends, hand.radii, strict=True):
            link = manifold_of(capsule(start, end, radius))
            assert body.min_gap(link, CLEAR_MM) > 0.5


def test_a_jig_can_only_be_drawn_away_and_passes_the_tool(stand):
    for pose, jig in stand.jigs.items():
        tool, body = solid_tool(stand.scenes[pose]), manifold_of(jig.mesh)
        away = stand.away[pose]
        for step in np.linspace(0, AWAY_MM, 10):
            assert (moved(body, step * away) ^ tool).volume() < INTERFERENCE_MM3
        assert (moved(body, -1.0 * away) ^ tool).volume() > 1.0  # the notches stop it
        across = np.array([-away[1], away[0], 0.0])
        for step in (8 * away, -2 * away, 2 * across, -2 * across, np.array([0, 0, -2.0])):
            shared = sum((moved(body, step) ^ manifold_of(p.mesh)).volume() for p in stand.bench)
            assert (shared > 1.0) == (step @ away < 1.0), f"{pose}: {step}"


def moved(body, step):
    return body.translate([float(x) for x in step])


def test_jigs_stand_in_their_channels_alone(stand):
    for jig in stand.jigs.values():
        for part in stand.bench:
            assert (manifold_of(jig.mesh) ^ manifold_of(part.mesh)).volume() < INTERFERENCE_MM3
    widths = [rib_width(number) for number in range(4)]
    assert np.diff(widths).min() > 2 * CLAY.print.clearance_mm


def test_no_room_is_told_in_figures(stand, build):
    scene = next(iter(stand.scenes.values()))
    narrow = find_place(scene, build[0].tool, FLOOR_MM, 1.0)
    assert narrow == -np.inf


def test_opening_keeps_the_joints_limits(build):
    spec, geometry, trajectories = build
    closed = next(iter(trajectories.values())).position_rad[0].reshape(len(geometry.fingers), 3)
    wide = opened(spec, closed, 1.0)
    assert np.all(wide <= closed) and np.all(wide[:, 1] == closed[:, 1])
    assert np.degrees(closed - wide).max() == pytest.approx(OPENED_DEG)
    for n, joint in enumerate(("mcp_flex", "mcp_abd", "ip_flex")):
        low = np.radians(spec.hand.joint_limits_deg[joint][0])
        assert np.all(wide[:, n] >= np.minimum(low, closed[:, n]) - 1e-9)


def test_the_stands_frame_is_right_handed():
    T = stand_frame(np.eye(4))
    assert np.allclose(T[:3, :3].T @ T[:3, :3], np.eye(3)) and np.linalg.det(T) == pytest.approx(1)
    assert np.allclose(T[:3, 0], [0, 0, -1])  # towards the hand


def test_a_build_has_the_stand_and_tells_how_to_use_it(built_clay, stand):
    parts = built_clay / "parts"
    names = [file.stem for file in (parts / "print").glob("*.3mf")]
    jigs = [name for name in names if name.startswith("jig_")]
    assert "bench_stand" in names and jigs
    guide = (parts / "assembly.md").read_text(encoding="utf-8")
    bill = (parts / "bom.csv").read_text(encoding="utf-8")
    for name in ("bench_stand", *jigs):
        assert f"`{name}`" in guide and f"\n{name},printed,1" in bill
    assert "stand_screw,bought,4,M6" in bill and len(stand_rows(CLAY)) == 2
    assert len(bench_steps(stand)) == 5
    assert read_json(parts / "assembly.json")["about"]


@pytest.fixture(scope="module")
def filed(build, built_clay):
    """Assembly and stand as a build's files tell them."""
    spec, geometry, trajectories = build
    parts = built_clay / "parts"
    return read_inventory(parts), read_stand(spec, geometry, trajectories, parts)


def test_the_files_of_stand_and_jigs_pass_their_gates_again(built_clay, build, filed):
    assembly, stand = filed
    rows = list(csv.DictReader((built_clay / "parts" / "checks.csv").open(encoding="utf-8")))
    told = {(row["gate"], row["part"]): float(row["value"]) for row in rows}
    found = check_stand(build[0], build[1], assembly, stand)
    assert {f.part for f in found} == {part.name for part in stand.parts}
    for finding in found:
        value = told[finding.gate, finding.part]
        assert finding.value == pytest.approx(value, rel=0.02, abs=0.02), str(finding)


def test_a_jig_that_was_moved_into_the_hand_is_found(build, filed):
    spec, geometry, _ = build
    assembly, stand = filed
    pose, jig = next(iter(stand.jigs.items()))
    inwards = jig.mesh.copy().apply_translation(-15.0 * stand.away[pose])
    moved_in = replace(stand, parts=(replace(jig, mesh=inwards),))
    (fault,) = [f for f in check_stand(spec, geometry, assembly, moved_in) if f.gate == GATE]
    assert fault.severity is Severity.WARNING and fault.part == f"jig_{pose}"
    assert fault.value < fault.limit
