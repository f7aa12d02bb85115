from __future__ import annotations

import base64
import json
import re
import zlib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from fpcad.errors import StoreError
from fpcad.look import meshes
from fpcad.look.curves import efficiency, outcome_counts, range_shares, share_above
from fpcad.look.document import OPENING, build_document
from fpcad.look.figures import FIGURES, write_figures
from fpcad.look.hands import hand_dimensions
from fpcad.look.holding import HoldingForces
from fpcad.look.kept import KEYFRAMES
from fpcad.look.layout import layout_of
from fpcad.look.meshes import SHOWN_WITHIN_MM, LinkMesh, chosen_meshes, simplified
from fpcad.look.pack import Packer
from fpcad.look.paths import PathStates, stored_paths
from fpcad.look.poses import pose_states
from fpcad.look.report import report_page
from fpcad.look.run import Run
from fpcad.look.tables import csv_text, hands, latex_escaped, latex_text
from fpcad.model.geometry import hand_geometry
from fpcad.model.hand import hand_template
from fpcad.model.pose import PoseModel
from fpcad.select.columns import numbers

TYPES = {"f4": "<f4", "i2": "<i2", "i4": "<i4", "u1": "u1"}


def unpacked(reference: dict[str, Any], blocks: dict[str, str]) -> np.ndarray:
    """What the page's script makes of a reference, in a few lines of Python."""
    name, n, at = reference["in"], reference["n"], reference["at"]
    kind = np.dtype(TYPES[reference["type"]])
    block = base64.b64decode(blocks[name])
    if name == OPENING:  # the plain one
        assert at % kind.itemsize == 0
        values = np.frombuffer(block, kind, n, at)
    else:
        planes = np.frombuffer(zlib.decompress(block), np.uint8, n * kind.itemsize, at)
        values = planes.reshape(kind.itemsize, n).T.copy().view(kind)
    values = values.reshape(reference["shape"])
    if "scale" not in reference:
        return values
    if reference["delta"]:
        values = np.cumsum(values, axis=-1, dtype=np.int16)
    exact = reference["offset"] + reference["scale"] * values.astype(float)
    return np.where(values == -32768, np.nan, exact)


@pytest.mark.parametrize("delta", [False, True])
def test_quantized_numbers_come_back_within_a_65000th_of_their_range(delta):
    values = np.random.default_rng(0).normal(size=(7, 5, 9))
    pack = Packer("a")
    reference = pack.quantized(values, delta)
    found = unpacked(reference, {"a": pack.text()})
    assert np.abs(found - values).max() <= np.ptp(values) / 65_000
    assert np.abs(found - values).max() > 0


@pytest.mark.parametrize("name", ["a", OPENING])
def test_packed_numbers_come_back_as_they_were(name):
    pack = Packer(name, plain=name == OPENING)
    told = [
        (pack.integers([1, 2, 3]), [1, 2, 3]),
        (pack.exact([1.5, np.nan]), [1.5, np.nan]),
        (pack.integers([-1, 70_000]), [-1, 70_000]),
        (pack.integers(np.array([True, False])), [1, 0]),
        (pack.quantized([np.nan, 2.0, 3.0]), [np.nan, 2.0, 3.0]),
        (pack.quantized([]), []),
    ]
    for reference, values in told:
        assert unpacked(reference, {name: pack.text()}) == pytest.approx(
            np.array(values), nan_ok=True
        )


def test_dimensions_are_those_that_parts_are_made_of(real_run: Run):
    sizes = hand_dimensions(real_run)
    for row, design in enumerate(real_run.space.internal(real_run.designs)):
        geometry = hand_geometry(hand_template(real_run.spec.hand), design)
        assert sizes.radius_mm[row] == pytest.approx(geometry.radius_mm)
        assert sizes.proximal_mm[row] == pytest.approx(geometry.proximal_length_mm)
        tip = geometry.distal_length_mm - geometry.radius_mm
        assert sizes.distal_axis_mm[row] == pytest.approx(tip)
        roots = np.array([T[:3, 3] for T in geometry.T_palm_root.values()])
        assert sizes.root_position_mm[row] == pytest.approx(roots)


def test_contact_forces_balance_the_load_at_the_tip(real_run: Run):
    for pose in real_run.poses:
        layout, y = layout_of(real_run.spec, pose), pose_states(real_run, pose)
        n = len(y)
        designs = real_run.space.internal(real_run.designs)
        x = y[:, layout.hand.stop :]
        holding = HoldingForces(real_run.spec, pose)
        forces = holding.at(designs, y[:, :6], np.zeros(n), x, np.ones(n))
        model = PoseModel(real_run.spec, pose)
        import casadi as ca

        tip = np.array(ca.evalf(ca.substitute(model.tip_wrench(), model.turn, 0))).ravel()
        load = real_run.spec.poses[pose].tip_force_n * tip[:3]
        assert forces.sum(axis=1) == pytest.approx(np.tile(-load, (n, 1)), abs=1e-6)


def test_paths_are_read_in_one_pass_as_they_are_one_by_one(real_run: Run):
    ids = real_run.ids[real_run.front].tolist()
    read = list(stored_paths(real_run.folder / "paths.parquet", ids))
    assert sorted({path.id for path in read}) == sorted(ids)
    for path in read:
        rows = [r for r in real_run.paths(path.id).to_pylist() if r["pose"] == path.pose]
        assert path.tool_angle_rad.tolist() == [r["tool_angle_rad"] for r in rows]
        assert path.joints_rad.tolist() == [r["joints_rad"] for r in rows]


def test_keyframes_keep_both_ends_and_the_pose():
    angles = np.array([-0.5, -0.1, 0.0, 0.3, 1.1])
    path = PathStates(0, "any", angles, np.sin(angles)[:, None], np.zeros((5, 4)))
    kept = path.keyframes(KEYFRAMES)
    assert {-0.5, 0.0, 1.1} <= set(kept.tool_angle_rad.tolist())
    assert (np.diff(kept.tool_angle_rad) > 0).all()
    assert kept.joints_rad[kept.tool_angle_rad == 0.0] == 0.0


def test_the_chosen_hand_has_all_of_its_states_and_the_front_its_keyframes(real_run: Run):
    document, blocks = build_document(real_run)
    chosen, opening = document["chosen"], document["opening"]
    assert opening["row"] == chosen
    for pose in real_run.poses:
        (path,) = (p for p in opening["exact"] if p["row"] == chosen and p["pose"] == pose)
        rows = [
            r for r in real_run.paths(int(real_run.ids[chosen])).to_pylist() if r["pose"] == pose
        ]
        expected = np.array([r["joints_rad"] for r in rows])
        assert unpacked(path["joints"], blocks) == pytest.approx(expected, abs=3e-7)
        turns = unpacked(document["thin"]["poses"][pose]["turn"], blocks)
        assert turns.shape[2] == KEYFRAMES
    exact = {path["row"] for path in [*opening["exact"], *document["exact"]]}
    thin = set(unpacked(document["thin"]["rows"], blocks).tolist())
    assert exact | thin >= set(np.flatnonzero(real_run.front).tolist())


def test_the_page_opens_with_the_first_block_alone(real_run: Run):
    document, blocks = build_document(real_run)
    later = ("hand", "poses", "exact", "thin", "meshes")
    opening = json.dumps({name: told for name, told in document.items() if name not in later})
    assert set(re.findall(r'"in": "(\w+)"', opening)) == {"opening"} == set(list(blocks)[:1])


def test_each_mesh_of_the_urdf_is_there_once(real_run: Run):
    found = chosen_meshes(real_run.folder / "hand" / "urdf" / "clay.urdf")
    assert len({mesh.file for mesh in found}) == len(found)
    links = {link for mesh in found for link in mesh.links}
    assert {"palm", "thumb_mcp", "index_proximal", "ring_distal"} <= links
    assert all(np.abs(mesh.vertices_mm).max() < 300 for mesh in found)


def ball(halvings: int) -> LinkMesh:
    sphere = trimesh.creation.icosphere(subdivisions=halvings, radius=20.0)
    return LinkMesh("ball", ("palm",), sphere.vertices, sphere.faces, (1.0, 1.0, 1.0))


def test_a_fine_mesh_loses_triangles_and_keeps_its_surface():
    (shown,) = simplified([ball(6)])
    assert len(shown.faces) < len(ball(6).faces) / 10
    assert np.linalg.norm(shown.vertices_mm, axis=1) == pytest.approx(20.0, abs=SHOWN_WITHIN_MM)


def test_too_many_triangles_are_shown_coarser(monkeypatch: pytest.MonkeyPatch):
    (fine,) = simplified([ball(5)])
    monkeypatch.setattr(meshes, "MAX_TRIANGLES", len(fine.faces) - 1)
    (coarse,) = simplified([ball(5)])
    assert 20 < len(coarse.faces) < len(fine.faces)


def test_a_mesh_that_is_not_closed_stays_as_it_is():
    whole = ball(3)
    open_one = replace(whole, faces=whole.faces[1:])
    assert simplified([open_one]) == [open_one]


def test_a_page_holds_everything_and_is_the_same_again(made_up: Run):
    page = report_page(made_up)
    assert page == report_page(made_up)
    assert not re.search(r"<(script|link|img)[^>]*(src|href)=\"(?!data:)", page)
    data = re.search(r'<script type="application/json" id="run">(.*?)</script>', page, re.DOTALL)
    assert data
    assert json.loads(data.group(1))["candidates"]["count"] == 60


def test_the_summary_stands_before_every_script_and_all_data(made_up: Run):
    before, _, _ = report_page(made_up).partition("<script")
    assert made_up.selected is not None
    assert f"Chosen: hand {made_up.selected['id']}" in before
    assert "</main>" in before


def test_shares_are_counted_above_each_threshold():
    values = np.array([0.0, 10.0, 10.0, 30.0, np.nan])
    assert share_above(values, np.array([0.0, 5.0, 10.0, 40.0])).tolist() == [0.6, 0.6, 0.2, 0.0]


def test_efficiency_ends_with_all_calls(made_up: Run):
    found = efficiency(made_up)
    assert found.calls[-1] == made_up.calls.num_rows
    assert found.cumulative[-1] == pytest.approx(59 / made_up.calls.num_rows)
    assert sum(outcome_counts(made_up).values()) == made_up.calls.num_rows


def test_all_hands_turn_the_tool_further_than_not_at_all(made_up: Run):
    thresholds, shares = range_shares(made_up)
    assert thresholds[0] == 0
    assert all(share[0] == 1.0 and share[-1] == 0.0 for share in shares.values())


def test_figures_are_written_and_are_the_same_again(made_up: Run, tmp_path: Path):
    first = write_figures(made_up, tmp_path / "a", ("svg",))
    second = write_figures(made_up, tmp_path / "b", ("svg",))
    assert [file.stem for file in first] == list(FIGURES)
    assert [file.read_bytes() for file in first] == [file.read_bytes() for file in second]


def test_a_pdf_is_a_pdf(made_up: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("fpcad.look.figures.FIGURES", {"front": FIGURES["front"]})
    for file in write_figures(made_up, tmp_path, ("pdf",)):
        assert file.read_bytes().startswith(b"%PDF")


def test_csv_keeps_all_digits_and_puts_the_best_first(made_up: Run):
    text = csv_text(hands(made_up, ["id", "mean_score"]))
    rows = [line.split(",") for line in text.splitlines()]
    assert rows[0] == ['"id"', '"mean_score"']
    scores = [float(score) for _, score in rows[1:]]
    assert scores == sorted(numbers(made_up.table, "mean_score"), reverse=True)


def test_the_front_is_a_part_of_the_table(made_up: Run):
    assert hands(made_up, front=True).num_rows == int(made_up.front.sum())


def test_a_column_that_is_not_there_is_named(made_up: Run):
    with pytest.raises(StoreError, match='no column "mean_scor"'):
        hands(made_up, ["mean_scor"])


def test_latex_escapes_names_and_has_a_line_for_each_hand(made_up: Run):
    text = latex_text(hands(made_up, ["id", "mean_score", "pareto"]))
    assert r"mean\_score" in text
    assert text.count(r"\\") == 61
    assert latex_escaped("50% & #1") == r"50\% \& \#1"
