"""Slicing is PrusaSlicer's work; fpcad calls it, reads what it says, and tells when it is missing."""

from __future__ import annotations

import shutil

import pytest
import trimesh

from fpcad.errors import StoreError, ToolchainError
from fpcad.make.documents import slicing
from fpcad.make.documents.slicing import PROGRAMS, filament_cm3, hours_of, slice_folder, slicer
from tests.make.hands import CLAY


@pytest.mark.parametrize(
    ("told", "hours"),
    [("1d 2h 30m 36s", 26.51), ("2h 0m 0s", 2.0), ("45m 0s", 0.75), ("36s", 0.01)],
)
def test_print_times_are_read(told, hours):
    text = f"G1 X1\n; estimated printing time (normal mode) = {told}\n"
    assert hours_of(text) == pytest.approx(hours)


def test_filament_is_read():
    assert filament_cm3("; filament used [mm] = 9\n; filament used [cm3] = 1.25\n") == 1.25


@pytest.mark.parametrize("read", [hours_of, filament_cm3])
def test_a_file_that_says_nothing_is_refused(read):
    with pytest.raises(ToolchainError, match="the slicer told no"):
        read("G1 X1\n")


def test_a_missing_slicer_is_named(monkeypatch):
    monkeypatch.setattr(slicing.shutil, "which", lambda _: None)
    with pytest.raises(ToolchainError, match="apt-get install prusa-slicer"):
        slicer()


@pytest.mark.skipif(
    not any(map(shutil.which, PROGRAMS)), reason="PrusaSlicer is not installed; see docs/checks.md"
)
def test_a_small_part_is_sliced(tmp_path):
    (tmp_path / "print").mkdir()
    trimesh.creation.box((8, 8, 4)).apply_translation((0, 0, 2)).export(
        tmp_path / "print" / "a.stl"
    )
    (sliced,) = slice_folder(tmp_path, CLAY.print, 0.2)
    assert sliced.part == "a" and sliced.file.is_file()
    assert 0.01 < sliced.hours < 0.5 and 0.1 < sliced.filament_g < 2


def test_a_folder_without_print_files_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(slicing, "slicer", lambda: "prusa-slicer")
    with pytest.raises(StoreError, match="nothing to slice"):
        next(slice_folder(tmp_path, CLAY.print, 0.2))
