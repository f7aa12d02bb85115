"""A good package to break."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.make.hands import CENTRE
from tests.make.simple_hand import write_simple_hand


@pytest.fixture(scope="session")
def good(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A `hand` folder without fault."""
    return write_simple_hand(CENTRE, tmp_path_factory.mktemp("good") / "hand")


@pytest.fixture
def package(good: Path, tmp_path: Path) -> Path:
    """A copy of it that a test may spoil."""
    return shutil.copytree(good, tmp_path / "hand")
