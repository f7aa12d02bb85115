"""The valid spec that the tests of this folder break."""

from __future__ import annotations

from pathlib import Path

HERE = Path(__file__).parent
REPOSITORY = HERE.parent.parent
BASE_TEXT = (HERE / "base.yaml").read_text(encoding="utf-8")


def changed(*edits: tuple[str, str]) -> str:
    """The base spec with each edit's old text, which must occur, replaced once."""
    text = BASE_TEXT
    for old, new in edits:
        assert old in text, f"base.yaml lacks {old!r}"
        text = text.replace(old, new, 1)
    return text
