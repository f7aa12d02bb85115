from pathlib import Path

import pytest

from fpcad.spec import find_faults, load_spec, spec_hash
from fpcad.spec.wiring import Wiring
from tests.spec.base import changed

FINGERS = ("thumb", "index", "middle", "ring")


def with_wiring(tmp_path: Path, text: str) -> Path:
    file = tmp_path / "hand.yaml"
    file.write_text(changed(("{type: STS3215-12V}", f"{{wiring: {{{text}}}}}")))
    return file


def test_motors_are_numbered_in_order_unless_told():
    wiring = Wiring(ids={"index": (20, 21, 22)}, signs={"ring": (1, -1, 1)})
    assert wiring.numbers(FINGERS) == (1, 2, 3, 20, 21, 22, 7, 8, 9, 10, 11, 12)
    assert wiring.directions(FINGERS)[-3:] == (1, -1, 1)
    assert wiring.ratios(FINGERS) == (1.0,) * 12


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("ids: {index: [1, 21, 22]}", "an id of its own"),
        ("ids: {indx: [20, 21, 22]}", "index"),
        ("ids: {index: [20, 21]}", "3"),
        ("ids: {index: [20, 21, 253]}", "252"),
        ("signs: {index: [1, 0, 1]}", "-1"),
        ("gear_ratios: {index: [1, 0, 1]}", "greater than 0"),
    ],
)
def test_faulty_wirings_are_told(tmp_path, text, words):
    (fault,) = find_faults(with_wiring(tmp_path, text))
    assert words in str(fault) and "motors.wiring" in str(fault)


def test_rewiring_makes_no_stage_stale(tmp_path):
    one = load_spec(with_wiring(tmp_path, ""))
    two = load_spec(with_wiring(tmp_path, "ids: {thumb: [31, 32, 33]}"))
    assert spec_hash(one, "motors") == spec_hash(two, "motors")
    assert spec_hash(one) != spec_hash(two)
