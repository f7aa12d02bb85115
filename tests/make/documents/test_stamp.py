"""Every file that an export writes says whose it is."""

from __future__ import annotations

import csv
import io
import json
import xml.etree.ElementTree as ET
import zipfile
from pathlib import Path

import pytest
import trimesh
from trimesh.exchange.gltf import export_glb

from fpcad.errors import MakeError
from fpcad.make.documents.stamp import Stamp
from fpcad.spec.dump import spec_hash
from fpcad.spec.load import load_spec
from fpcad.store import read_json
from tests.make.hands import STAMP

WRITTEN = ("hand", "parts", "trajectories", "grip.json", "survival.json")
"""What the stage export writes in a build's folder."""


def carries(file: Path, stamp: Stamp) -> bool:
    """Whether a file holds the stamp, or a table its columns."""
    if file.suffix == ".csv":
        rows = list(csv.DictReader(io.StringIO(file.read_text(encoding="utf-8"))))
        told = {(row["hand"], row["spec_sha256"]) for row in rows}
        return told == {(stamp.hand, stamp.spec_sha256)}
    if file.suffix == ".3mf":
        with zipfile.ZipFile(file) as archive:
            return stamp.text.encode() in archive.read("3D/3dmodel.model")
    return stamp.text.encode() in file.read_bytes()


def test_every_file_of_a_build_carries_the_stamp(built_clay: Path):
    spec = load_spec(built_clay / "spec.yaml")
    chosen = int(read_json(built_clay / "selected.json")["id"])
    stamp = Stamp(spec.name, chosen, spec_hash(spec))
    roots = [built_clay / name for name in WRITTEN]
    files = [f for root in roots for f in (root.rglob("*") if root.is_dir() else [root])]
    files = [file for file in files if file.is_file()]
    assert len(files) > 100
    assert [str(file) for file in files if not carries(file, stamp)] == []


@pytest.mark.parametrize("suffix", [".urdf", ".xml", ".srdf", ".xacro"])
def test_xml_keeps_its_declaration_first(suffix):
    stamped = STAMP.on(suffix, '<?xml version="1.0"?>\n<robot name="a"/>\n').decode()
    assert stamped.splitlines()[:2] == ['<?xml version="1.0"?>', f"<!-- {STAMP.text} -->"]
    assert ET.fromstring(stamped).get("name") == "a"


@pytest.mark.parametrize("text", ["{}\n", '{"a":1}\n', '{\n  "a": 1\n}\n'])
def test_json_keeps_what_it_says(text):
    assert json.loads(STAMP.on(".json", text)) == {"about": STAMP.text, **json.loads(text)}


def test_a_table_gets_columns():
    stamped = STAMP.on(".csv", 'a,b\n1,"x,\ny"\n').decode()
    (row,) = csv.DictReader(io.StringIO(stamped))
    assert row == {"a": "1", "b": "x,\ny", "hand": "24", "spec_sha256": STAMP.spec_sha256}


def test_a_binary_gltf_is_read_as_before():
    box = trimesh.creation.box((1, 2, 3))
    stamped = STAMP.on(".glb", bytes(export_glb(trimesh.Scene(box))))
    read = trimesh.load_scene(io.BytesIO(stamped), file_type="glb").to_mesh()
    assert read.volume == pytest.approx(6)
    assert len(stamped) == int.from_bytes(stamped[8:12], "little") and len(stamped) % 4 == 0


def test_what_cannot_carry_a_stamp_is_refused():
    for suffix, content in ((".exe", "a"), (".xml", "<a/>"), (".json", "[1]"), (".step", "a")):
        with pytest.raises(MakeError):
            STAMP.on(suffix, content)
