"""Described hands of several shapes, and the files that describe them."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.make.hands import CENTRE, CORNERS
from tests.make.simple_hand import write_simple_hand


@pytest.fixture(scope="session")
def described(tmp_path_factory: pytest.TempPathFactory) -> dict[tuple[float, ...], Path]:
    """The `hand` folders of hands of several shapes, by design."""
    return {
        values: write_simple_hand(values, tmp_path_factory.mktemp("described") / "hand")
        for values in (CENTRE, *CORNERS)
    }
