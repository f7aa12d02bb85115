"""One made hand for all tests of this folder."""

from __future__ import annotations

from pathlib import Path

import pytest

from fpcad.make.hand import make_hand
from fpcad.make.parts.part import Part
from tests.make.hands import CENTRE, CLAY, geometry_of, parts_of


@pytest.fixture(scope="session")
def clay_parts() -> dict[str, Part]:
    """Parts of the hand at the centre of clay's box, by name."""
    return {part.name: part for part in parts_of(CENTRE)}


@pytest.fixture(scope="session")
def clay_hand(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build folder of the hand at the centre of clay's box."""
    out = tmp_path_factory.mktemp("clay")
    make_hand(CLAY, geometry_of(CENTRE), out)
    return out
