"""Whatever a file holds, reading it ends in a spec or in faults, never in another error."""

from __future__ import annotations

import random

import pytest

from fpcad.spec.load import parse_spec
from tests.spec.base import BASE_TEXT

SCRAPS = [
    *"{}[]:-,&*!|>%@`'\"\t\n #?<~.e0_x\\\x07\u2028é\r",
    *("<<: ", "- ", "&a ", "*a ", "!!int ", "? ", "%YAML 1.1\n", "---\n", "...\n", "null", "1_"),
    *("0x", "0o", "0b", "._", "-.inf", ".nan", "1:30", "2001-01-01", "\ufeff", "|-\n", ">+2\n"),
    "9" * 5000,
]


def damaged(text: str, dice: random.Random) -> str:
    for _ in range(dice.randint(1, 4)):
        at, skipped = dice.randrange(len(text)), dice.choice([0, 0, 1, 12])
        text = text[:at] + dice.choice(["", *SCRAPS]) + text[at + skipped :]
    return text


@pytest.mark.parametrize("seed", range(150))
def test_damaged_specs_are_told_not_crashed_on(seed: int) -> None:
    spec, faults = parse_spec(damaged(BASE_TEXT, random.Random(seed)), "f")
    assert spec is not None or faults
    assert not any("\n" in str(fault) for fault in faults)
    assert faults == sorted(faults, key=lambda fault: (fault.line, fault.column))
