"""The verbs about what is printed, as people call them."""

from __future__ import annotations

import json

from typer.testing import CliRunner

from fpcad.cli import app
from fpcad.errors import StoreError, ToolchainError
from fpcad.make.documents import slicing

RUN = CliRunner()


def test_check_passes_a_finished_build_and_tells_its_figures(built_clay):
    result = RUN.invoke(app, ["check", str(built_clay), "--json"])
    assert result.exit_code == 0
    findings = json.loads(result.stdout)
    assert {"wall", "bed", "tubes", "joint", "interference", "reach"} <= {
        f["gate"] for f in findings
    }
    assert {f["severity"] for f in findings} <= {"figure", "warning"}


def test_check_fails_where_a_file_was_damaged(built_clay, tmp_path):
    import shutil

    import numpy as np
    import trimesh

    broken = shutil.copytree(built_clay, tmp_path / "clay")
    file = next((broken / "parts" / "skin").glob("*.stl"))
    mesh = trimesh.load_mesh(file)
    mesh.update_faces(np.arange(len(mesh.faces)) > 0)
    mesh.export(file)
    result = RUN.invoke(app, ["check", str(broken)])
    assert result.exit_code == 6 and "its mesh is not closed" in result.stdout


def test_slice_says_what_is_missing(built_clay, monkeypatch):
    monkeypatch.setattr(slicing.shutil, "which", lambda _: None)
    result = RUN.invoke(app, ["slice", str(built_clay)])
    assert isinstance(result.exception, ToolchainError)
    assert "apt-get install prusa-slicer" in str(result.exception)


def test_a_folder_without_a_hand_is_told(tmp_path):
    result = RUN.invoke(app, ["check", "nobody", "--build", str(tmp_path)])
    assert isinstance(result.exception, StoreError) and "fpcad design nobody" in str(
        result.exception
    )
