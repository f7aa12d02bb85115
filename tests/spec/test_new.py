"""The starting spec is valid as it stands and teaches its keys."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from fpcad.errors import SpecError
from fpcad.spec import find_faults, load_spec, write_new
from fpcad.spec.load import parse_spec
from fpcad.spec.new import starter_text


def test_a_new_spec_is_valid_under_its_own_name(tmp_path: Path) -> None:
    path = write_new("paint-brush_2", tmp_path / "designs")
    assert path == tmp_path / "designs" / "paint-brush_2.yaml"
    assert find_faults(path) == []
    spec = load_spec(path)
    assert (spec.name, spec.initial, len(spec.poses)) == ("paint-brush_2", None, 2)
    assert [file.name for file in path.parent.iterdir()] == ["paint-brush_2.yaml"]


def test_nothing_is_overwritten(tmp_path: Path) -> None:
    path = write_new("brush", tmp_path)
    path.write_text("mine", encoding="utf-8")
    with pytest.raises(SpecError, match=r"brush\.yaml: found a file of this name"):
        write_new("brush", tmp_path)
    assert path.read_text(encoding="utf-8") == "mine"


@pytest.mark.parametrize(
    "name", ["", "../up", "Brush", "2d", "a b", "a/b", "x" * 41, "brush\n", "é"]
)
def test_names_that_are_no_plain_names(tmp_path: Path, name: str) -> None:
    with pytest.raises(
        SpecError, match="as a design's name; allowed: a name of lower-case"
    ) as caught:
        write_new(name, tmp_path)
    assert "\n" not in str(caught.value)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_a_file(tmp_path: Path) -> None:
    (tmp_path / "designs").write_text("", encoding="utf-8")
    with pytest.raises(SpecError, match="designs: found a file of this name"):
        write_new("brush", tmp_path / "designs")


def test_the_optional_keys_it_shows_are_valid_defaults() -> None:
    text = starter_text("brush")
    spec = parse_spec(text)[0]
    shown = re.sub(r"^( *(?:- )?)# ((?:[a-z]\w*): \S.*)$", r"\1\2", text, flags=re.MULTILINE)
    assert shown.count("\n# ") < text.count("\n# ")
    uncommented, faults = parse_spec(shown)
    assert faults == []
    assert uncommented is not None
    assert spec is not None
    assert uncommented.sampling.min_distance == pytest.approx(spec.sampling.min_distance, rel=2e-3)
    same = {"sampling": spec.sampling, "hand": spec.hand}
    assert uncommented.model_copy(update=same) == spec
