"""What the tests of this folder share of a made hand."""

from __future__ import annotations

from pathlib import Path

import pytest

from fpcad.make.parts.part import Part
from fpcad.store import read_json
from tests.make.hands import CENTRE, parts_of


@pytest.fixture(scope="session")
def clay_parts() -> dict[str, Part]:
    """Parts of the hand at the centre of clay's box, by name."""
    return {part.name: part for part in parts_of(CENTRE)}


@pytest.fixture(scope="session")
def clay_hand(built_clay: Path) -> Path:
    """Build folder of the hand at the centre of clay's box."""
    design = read_json(built_clay / "selected.json")["design"]
    assert tuple(design.values()) == pytest.approx(CENTRE)
    return built_clay
