"""Resolved specs read back equal, and hashes follow values, not the way they are written."""

from __future__ import annotations

from pathlib import Path

import pytest

from fpcad.spec import Spec, dump_spec, load_spec, spec_hash
from fpcad.spec.load import parse_spec
from tests.spec.base import BASE_TEXT, HERE, REPOSITORY, changed

FILES = [HERE / "base.yaml", REPOSITORY / "designs" / "clay.yaml"]


def read(text: str) -> Spec:
    spec, faults = parse_spec(text)
    assert faults == []
    assert spec is not None
    return spec


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_a_dump_reads_back_equal(path: Path) -> None:
    spec = load_spec(path)
    again = read(dump_spec(spec))
    assert again == spec
    assert dump_spec(again) == dump_spec(spec)
    assert list(again.poses) == list(spec.poses)


def test_a_dump_shows_defaults() -> None:
    text = dump_spec(read(BASE_TEXT))
    assert "skin_thickness_mm: 1.5" in text
    assert "link: distal" in text


def test_the_hash_does_not_depend_on_the_writing() -> None:
    rewritten = changed(
        ("radius_mm: 6", "radius_mm: 6.0"),
        ("solver: {method: sqp}", "print: {skin_thickness_mm: 1.5}"),  # defaults, spelt out
        ("fpcad: 1\nname: base\n", "# a comment\nname: base\nfpcad: 1\n"),
    )
    assert spec_hash(read(rewritten)) == spec_hash(read(BASE_TEXT))


def test_the_hash_is_stable() -> None:
    assert spec_hash(read(BASE_TEXT), "tool", "statics") == TOOL_AND_STATICS_HASH


def test_the_hash_follows_the_sections_that_it_names() -> None:
    base, other = read(BASE_TEXT), read(changed(("radius_mm: 6", "radius_mm: 6.5")))
    assert spec_hash(base) != spec_hash(other)
    assert spec_hash(base, "tool") != spec_hash(other, "tool")
    assert spec_hash(base, "hand", "poses") == spec_hash(other, "hand", "poses")
    assert spec_hash(base, "hand", "poses") == spec_hash(base, "poses", "hand")


def test_the_order_of_poses_counts() -> None:
    spec = read(BASE_TEXT)
    two = spec.model_copy(update={"poses": {"a": spec.poses["hold"], "b": spec.poses["hold"]}})
    swapped = two.model_copy(update={"poses": dict(reversed(two.poses.items()))})
    assert spec_hash(two, "poses") != spec_hash(swapped, "poses")


def test_unknown_sections_have_no_hash() -> None:
    with pytest.raises(ValueError, match="no sections"):
        spec_hash(read(BASE_TEXT), "tol")


TOOL_AND_STATICS_HASH = "57a0024d3c18c322c08404af172c61ecadda10345694b8b74f4262069d2fead8"
