"""What is printed, bought and read: every file says whose it is, and holds what was made."""

from __future__ import annotations

import csv
import zipfile
from pathlib import Path

import numpy as np
import pytest
import trimesh

from fpcad.errors import StoreError
from fpcad.make.bom import write_hours
from fpcad.make.documents.inventory import read_inventory
from fpcad.make.documents.recheck import recheck
from fpcad.make.documents.stamp import Stamp
from fpcad.make.documents.threemf import Item, threemf_bytes
from fpcad.make.gates.finding import errors
from fpcad.make.parts.assembly import Assembly
from fpcad.spec.dump import spec_hash
from fpcad.spec.load import load_spec
from tests.conftest import BUILT_HAND
from tests.make.hands import CENTRE, CLAY, STAMP, geometry_of, parts_of

GEOMETRY = geometry_of(CENTRE)


@pytest.fixture
def parts_folder(clay_hand: Path) -> Path:
    return clay_hand / "parts"


@pytest.fixture
def stamp(clay_hand: Path) -> Stamp:
    return Stamp("clay", BUILT_HAND, spec_hash(load_spec(clay_hand / "spec.yaml")))


@pytest.mark.parametrize("pattern", ["*/*.stl", "step/*.step", "assembly.json"])
def test_files_tell_hand_and_spec(parts_folder, stamp, pattern):
    found = sorted(parts_folder.glob(pattern))
    assert found
    assert all(stamp.text.encode() in file.read_bytes()[:400] for file in found)


def test_print_files_lie_on_the_bed(parts_folder):
    for file in (parts_folder / "print").glob("*.stl"):
        mesh = trimesh.load_mesh(file)
        assert mesh.is_watertight
        assert mesh.bounds[0, 2] == pytest.approx(0, abs=1e-4)
        assert mesh.bounds[:, :2].sum(axis=0) == pytest.approx([0, 0], abs=1e-3)


def test_3mf_has_millimetres_materials_and_the_stamp(parts_folder, stamp):
    with zipfile.ZipFile(parts_folder / "print" / "distal_skin.3mf") as archive:
        model = archive.read("3D/3dmodel.model").decode()
    for told in ('unit="millimeter"', 'base name="flexible (TPE)"', stamp.text):
        assert told in model
    read = trimesh.load_mesh(parts_folder / "print" / "distal_skin.3mf")
    laid = trimesh.load_mesh(parts_folder / "print" / "distal_skin.stl")
    assert read.volume == pytest.approx(laid.volume, rel=1e-4)


def test_3mf_of_equal_items_are_equal():
    item = Item("cube", "skin", "TPE", trimesh.creation.box((1, 2, 3)))
    assert threemf_bytes([item], STAMP) == threemf_bytes([item], STAMP)


def test_the_inventory_reads_back(parts_folder):
    made = Assembly(tuple(parts_of(CENTRE)), ())
    read = read_inventory(parts_folder)
    for a, b in zip(made.parts, read.parts, strict=True):
        assert (a.name, a.link, a.material, a.count) == (b.name, b.link, b.material, b.count)
        assert b.mesh.volume == pytest.approx(a.mesh.volume, rel=1e-5)
        assert b.solid.Volume() == pytest.approx(a.solid.Volume(), rel=1e-6)
        assert np.array_equal(a.places, b.places)


def test_the_bill_counts_and_weighs_and_names_power(parts_folder, stamp):
    rows = list(csv.DictReader((parts_folder / "bom.csv").open(encoding="utf-8")))
    by_item = {row["item"]: row for row in rows}
    palm = by_item["palm"]
    assert float(palm["mass_g"]) == pytest.approx(float(palm["volume_cm3"]) * 1.24, abs=0.01)
    assert (parts_folder / palm["file"]).is_file()
    assert {"power_supply", "fuse", "bus_adapter", "motor_cable"} <= set(by_item)
    assert {row["spec_sha256"] for row in rows} == {stamp.spec_sha256}


def test_hours_are_put_into_the_bill(parts_folder, tmp_path):
    bill = tmp_path / "bom.csv"
    bill.write_bytes((parts_folder / "bom.csv").read_bytes())
    write_hours(bill, {"palm": 3.721})
    rows = {row["item"]: row for row in csv.DictReader(bill.open(encoding="utf-8"))}
    assert rows["palm"]["hours"] == "3.72" and rows["fuse"]["hours"] == ""


def test_a_damaged_part_is_found_in_the_files(clay_hand, tmp_path):
    import shutil

    shutil.copytree(clay_hand / "parts", tmp_path / "parts")
    file = tmp_path / "parts" / "skin" / "distal_skin.stl"
    mesh = trimesh.load_mesh(file)
    mesh.update_faces(np.arange(len(mesh.faces)) != 7)
    mesh.export(file)
    ((title, found),) = recheck(CLAY, GEOMETRY, tmp_path)  # and nothing else is tried
    (fault,) = errors(found)
    assert title == "parts" and fault.part == "distal_skin" and "not closed" in fault.text


def test_a_folder_without_parts_is_told(tmp_path):
    with pytest.raises(StoreError, match="run `fpcad export clay` first"):
        next(recheck(CLAY, GEOMETRY, tmp_path))
