"""Specs are read strictly, and every fault is told at once, each with its place."""

from __future__ import annotations

import pickle
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from ruamel.yaml import YAML

from fpcad.errors import SpecError
from fpcad.spec import Fault, find_faults, load_spec
from fpcad.spec.load import parse_spec
from fpcad.spec.syntax import MAX_BYTES
from tests.spec.base import BASE_TEXT, HERE, REPOSITORY, changed

BROKEN: list[dict[str, Any]] = YAML(typ="safe").load(HERE / "broken.yaml")
JARGON = re.compile(
    r"pydantic|ruamel|Input should|function-|validat|Error|None|dict|tuple|NoneType"
)


def write(folder: Path, text: str | bytes) -> Path:
    path = folder / "design.yaml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def texts(text: str) -> list[str]:
    """Faults of a text as `line:column key: found` without what is allowed."""
    faults = parse_spec(text, "f")[1]
    return [str(f).removeprefix("f:").partition("; allowed:")[0] for f in faults]


def test_base_and_clay_are_valid() -> None:
    assert find_faults(HERE / "base.yaml") == []
    assert load_spec(HERE / "base.yaml").name == "base"
    assert load_spec(REPOSITORY / "designs" / "clay.yaml").name == "clay"


@pytest.mark.parametrize("case", BROKEN, ids=[case["what"] for case in BROKEN])
def test_each_fault_tells_place_find_and_allowance(case: dict[str, Any]) -> None:
    (fault,) = parse_spec(changed((case["old"], case["new"])), "base.yaml")[1]
    assert (fault.line, fault.column) == (case["line"], case["column"])
    assert fault.key == case["key"]
    assert fault.found == case["found"]
    assert fault.allowed == case["allowed"]


def test_there_are_many_broken_specs() -> None:
    assert len(BROKEN) > 90
    assert len({case["what"] for case in BROKEN}) == len(BROKEN)


@pytest.mark.parametrize("case", BROKEN, ids=[case["what"] for case in BROKEN])
def test_messages_are_one_line_in_plain_words(case: dict[str, Any]) -> None:
    (fault,) = parse_spec(changed((case["old"], case["new"])), "designs/base.yaml")[1]
    assert re.fullmatch(r"designs/base\.yaml:\d+:\d+( \S.*)?: found .+; allowed: .+", str(fault))
    assert not JARGON.search(str(fault))


def test_all_faults_come_at_once_in_the_order_of_lines() -> None:
    text = changed(
        ("radius_mm: 6", "radus_mm: 6"),  # schema
        ("thumb_root, end", "thumb_rot, end"),  # cross-check
        ("angle_deg: [5, 70]", "angle_deg: [5, 500]"),
        ("joint: mcp_abd", "joint: mcp"),
        ("method: sqp", "method: newton, method: sqp"),  # form
        ("STS3215-12V", "STS3215-9V"),
    )
    assert texts(text) == [
        "3:1 tool.radius_mm: found no such key",
        '3:25 tool.radus_mm: found unknown key "radus_mm"',
        '20:43 hand.palm[0].start: found "thumb_rot"',
        "26:69 poses.hold.contacts[1].angle_deg: found [5, 500]",
        '33:34 poses.hold.cost[2].joint: found "mcp"',
        '56:18 solver.method: found "newton"',
        '56:26 solver.method: found the key "method" again',
        '58:16 motors.type: found "STS3215-9V"',
    ]


def test_a_fault_in_one_pose_does_not_hide_those_of_another() -> None:
    pose = BASE_TEXT[BASE_TEXT.index("  hold:\n") : BASE_TEXT.index("initial:\n")]
    initial = BASE_TEXT[BASE_TEXT.index("initial:\n") : BASE_TEXT.index("statics:")]
    second = pose.replace("hold:", "lift:").replace("finger: thumb", "finger: toe")
    text = changed(
        (initial, ""), (pose, pose.replace("tip_force_n: 10", "tip_force_n: x") + second)
    )
    assert texts(text) == [
        '29:18 poses.hold.tip_force_n: found "x"',
        '36:18 poses.lift.contacts[0].finger: found "toe"',
    ]


def test_a_link_that_touches_twice_is_told_with_its_consequences() -> None:
    found = texts(changed(("finger: middle, axial_mm: [-35", "finger: index, axial_mm: [-35")))
    assert found[0] == "27:9 poses.hold.contacts[2]: found the index's distal link again"
    assert found[-1].startswith("52:9 initial.poses.hold.contacts: found contacts of thumb, index,")


def test_a_finger_may_touch_with_two_links() -> None:
    text = changed(
        ("finger: middle, axial_mm: [-35", "finger: index, link: proximal, axial_mm: [-35")
    )
    assert "contacts[2]: found the index's" not in "\n".join(texts(text))


def test_initial_poses_are_named_as_the_poses() -> None:
    assert texts(changed(("  poses:\n    hold:", "  poses:\n    hod:"))) == [
        "42:3 initial.poses.hold: found no such key",
        '43:5 initial.poses.hod: found unknown key "hod"',
    ]


def test_an_empty_mapping_lacks_every_required_key() -> None:
    faults = parse_spec("{}", "f")[1]
    assert [f.key for f in faults] == ["fpcad", "hand", "name", "poses", "tool"]
    assert {(f.line, f.column, f.found) for f in faults} == {(1, 1, "no such key")}


@pytest.mark.parametrize(
    ("text", "place", "found"),
    [
        (b"", (1, 1), "an empty file"),
        (b"# only a comment\n", (1, 1), "an empty file"),
        (b"- 1\n- 2\n", (1, 1), "[1, 2]"),
        (b"just words\n", (1, 1), '"just words"'),
        (b"null\n", (1, 1), "null"),
        (b"name: b\n# gr\xfc\xdfe\n", (2, 5), "the byte 0xfc"),
        (b"\xff\xfea\x00", (1, 1), "the byte 0xff"),
        (b"name: a\x00b\n", (1, 8), "the character U+0000"),
        (b"[" * 5000, (1, 32), "nesting too deep to be a spec"),
        (b"? " * 5000, (1, 3), "a list, a mapping or an alias as a key"),
        (b"#" * (MAX_BYTES + 1), (1, 1), f"a file of more than {MAX_BYTES} bytes"),
    ],
)
def test_files_that_are_no_specs(
    tmp_path: Path, text: bytes, place: tuple[int, int], found: str
) -> None:
    (fault,) = find_faults(write(tmp_path, text))
    assert (fault.line, fault.column) == place
    assert fault.found == found


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    (missing,) = find_faults(tmp_path / "none.yaml")
    (folder,) = find_faults(tmp_path)
    assert missing.found == "no such file or directory"
    assert folder.found == "is a directory"


def test_aliases_repeat_values() -> None:
    spec, faults = parse_spec(
        changed(
            ("axial_mm: [-5, 5]", "axial_mm: &middle [-5, 5]"),
            ("axial_mm: [8, 35]", "axial_mm: *middle"),
        )
    )
    assert faults == []
    assert spec is not None
    assert spec.poses["hold"].contacts[1].axial_mm == (-5, 5)


def test_aliases_cannot_blow_up() -> None:
    lines = ["a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1]"]
    lines += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 9)}]" for i in range(1, 12)]
    (fault,) = parse_spec("\n".join(lines), "f")[1]
    assert fault.line == 5
    assert fault.found == "more than 20000 values, repeated ones counted"


@pytest.mark.parametrize(
    ("written", "value"),
    [("1e-3", 1e-3), ("1E2", 100), ("6", 6), ("+6.5", 6.5), ("6.", 6), (".5", 0.5), ("0x10", 16)],
)
def test_numbers_as_people_write_them(written: str, value: float) -> None:
    spec, faults = parse_spec(changed(("radius_mm: 6", f"radius_mm: {written}")))
    assert faults == []
    assert spec is not None
    assert spec.tool.radius_mm == value


def test_angles_of_initial_poses_may_miss_a_limit_by_rounding() -> None:
    spec = load_spec(HERE / "base.yaml")
    assert spec.initial is not None
    assert spec.initial.poses["hold"].joints_deg["ring"][2] == 110.0009


def test_defaults_are_filled_in() -> None:
    spec = load_spec(HERE / "base.yaml")
    assert spec.poses["hold"].contacts[0].link == "distal"
    assert spec.print.skin_thickness_mm == 1.5


def test_the_error_lists_all_faults_and_survives_pickling(tmp_path: Path) -> None:
    path = write(tmp_path, changed(("radius_mm: 6", "radius_mm: x"), ("method: sqp", "method: y")))
    with pytest.raises(SpecError) as caught:
        load_spec(path)
    copy = pickle.loads(pickle.dumps(caught.value))
    assert str(copy) == str(caught.value) == "\n".join(map(str, find_faults(path)))
    assert len(str(copy).splitlines()) == 2
    assert (type(copy), copy.exit_code) == (SpecError, 2)


def test_faults_survive_pickling() -> None:
    fault = Fault("f", 1, 2, "tool", "a", "b")
    assert pickle.loads(pickle.dumps(fault)) == fault
    assert str(fault) == "f:1:2 tool: found a; allowed: b"
    assert str(Fault("f", 1, 2, "", "a", "b")) == "f:1:2: found a; allowed: b"


def test_hostile_keys_and_values_stay_on_one_line() -> None:
    text = changed(("solver:", '"a\\nb\\x1b[31m": 1\nsolver:'), ("method: sqp", 'method: "s\\nq"'))
    assert texts(text) == [
        '56:1 "a\\nb\\x1b[31m": found unknown key "a\\nb\\x1b[31m"',
        '57:18 solver.method: found "s\\nq"',
    ]


def test_reading_a_spec_imports_nothing_heavy() -> None:
    code = "import sys, fpcad.spec; print(sorted({'casadi','cadquery','numpy'} & set(sys.modules)))"
    run = [sys.executable, "-c", code]
    output = subprocess.run(run, cwd=REPOSITORY, check=True, capture_output=True, text=True).stdout
    assert output.strip() == "[]"
