"""Every check can fail: a good package is broken in one place, and the right check tells it."""

from __future__ import annotations

import json
import re
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path

import pytest
import trimesh
from ruamel.yaml import YAML

from fpcad.check_description import check_description
from fpcad.check_description.report import CHECKS

Break = Callable[[Path], None]

URDF, MJCF = "urdf/clay.urdf", "mjcf/clay.xml"
TABLE, LIMITS = "transmission.yaml", "clay_description/config/joint_limits.yaml"
TIP = "link[@name='index_distal']"
IP = "joint[@name='index_ip_flex']"


def attribute(path: str, key: str, value: str, file: str = URDF) -> Break:
    """Give an element another value."""

    def spoil(package: Path) -> None:
        tree = ET.parse(package / file)
        found = tree.getroot().find(path)
        assert found is not None and found.get(key) not in (None, value)
        found.set(key, value)
        tree.write(package / file)

    return spoil


def scaled(path: str, keys: str, factor: float, file: str = URDF) -> Break:
    """Multiply numbers of an element."""

    def spoil(package: Path) -> None:
        tree = ET.parse(package / file)
        found = tree.getroot().find(path)
        assert found is not None
        for key in keys.split():
            found.set(key, " ".join(str(factor * float(x)) for x in found.get(key, "").split()))
        tree.write(package / file)

    return spoil


def without(path: str, child: str, file: str = URDF) -> Break:
    """Remove all children of a kind."""

    def spoil(package: Path) -> None:
        tree = ET.parse(package / file)
        parents = tree.getroot().findall(path)
        assert parents
        for parent in parents:
            for found in parent.findall(child):
                parent.remove(found)
        tree.write(package / file)

    return spoil


def text(pattern: str, replacement: str, file: str) -> Break:
    """Replace the first place where a pattern matches."""

    def spoil(package: Path) -> None:
        changed, count = re.subn(pattern, replacement, (package / file).read_text(), count=1)
        assert count == 1
        (package / file).write_text(changed)

    return spoil


def mesh(name: str, factor: float) -> Break:
    """Scale a mesh file."""

    def spoil(package: Path) -> None:
        file = package / "meshes" / "visual" / f"{name}.stl"
        trimesh.load_mesh(file).apply_scale(factor).export(file)

    return spoil


def entry(row: int, column: int, value: float) -> Break:
    """Give the transmission's matrix another entry."""

    def spoil(package: Path) -> None:
        file = package / TABLE
        table = YAML(typ="safe").load(file)
        table["matrix"][row][column] = value
        file.write_text(json.dumps(table))

    return spoil


def gone(name: str) -> Break:
    """Delete a file."""
    return lambda package: (package / name).unlink()


MOMENTS = "ixx iyy izz ixy ixz iyz"
BROKEN = [
    ("names", text('name="ring_distal"', 'name=""', URDF), "link: 1 without a name"),
    ("names", attribute(IP, "name", "index_mcp_abd"), "the name is used 2 times"),
    ("names", attribute(IP, "name", "index ip"), "white space"),
    ("tree", attribute(f"{IP}/parent", "link", "nowhere"), "'nowhere' is no link"),
    ("tree", attribute(f"{IP}/child", "link", "ring_distal"), "is the child of 2 joints"),
    ("tree", attribute(f"{IP}/parent", "link", "index_distal"), "circle"),
    ("tree", without(".", IP), "2 roots instead of one: index_distal, palm"),
    ("tree", attribute(IP, "type", "rotary"), "there is no type 'rotary'"),
    ("meshes", gone("meshes/visual/palm.stl"), "there is no mesh"),
    ("meshes", lambda p: (p / "meshes/visual/palm.stl").write_text("?"), "has no triangles"),
    ("scale", mesh("palm", 1000.0), " m long; plausible are"),
    ("scale", mesh("palm", 0.1), "times as long as its collision"),
    ("scale", attribute(f"{TIP}/collision[1]/origin", "xyz", "0 0 0.9"), "as long as its collision"),
    ("collision", without(TIP, "collision"), "no neighbour covers it"),
    ("collision", without("link", "collision"), "has no collision shape at all"),
    ("inertia", without(TIP, "inertial"), "moves and has no inertial"),
    ("inertia", attribute(f"{TIP}/inertial/mass", "value", "0"), "weighs 0 kg"),
    ("inertia", attribute(f"{TIP}/inertial/inertia", "ixx", "-1e-9"), "not positive definite"),
    ("inertia", scaled(f"{TIP}/inertial/inertia", "izz", 3.0), "exceeds the sum of the others"),
    ("plausible inertia", scaled(f"{TIP}/inertial/inertia", MOMENTS, 1000.0), "filled evenly"),
    ("plausible inertia", scaled(f"{TIP}/inertial/inertia", MOMENTS, 0.001), "filled evenly"),
    ("plausible inertia", scaled(f"{TIP}/inertial/mass", "value", 1000.0), "kg/m^3"),
    ("plausible inertia", scaled(f"{TIP}/inertial/mass", "value", 0.001), "kg/m^3"),
    ("centre", attribute(f"{TIP}/inertial/origin", "xyz", "0.02 0 0.02"), "outside the hull"),
    ("limits", without(IP, "limit"), "has no limit"),
    ("limits", attribute(f"{IP}/limit", "upper", "-1"), "is empty"),
    ("limits", attribute(f"{IP}/limit", "upper", "110"), "more than two turns: degrees?"),
    ("limits", attribute(f"{IP}/limit", "effort", "0"), "its effort is 0"),
    ("limits", attribute(f"{IP}/limit", "velocity", "1000"), "its velocity is 1000"),
    ("limits", attribute(f"{IP}/safety_controller", "soft_upper_limit", "2.5"), "soft limits"),
    ("limits", attribute(f"{IP}/axis", "xyz", "0 2 0"), "its axis has the length 2"),
    ("effort", attribute(f"{IP}/limit", "effort", "100"), "a placeholder?"),
    ("MJCF", scaled(f"{TIP}/inertial/mass", "value", 1.001), "weighs"),
    ("MJCF", scaled(f"{TIP}/inertial/inertia", MOMENTS, 1.001), "its inertia differs"),
    ("MJCF", scaled(f"{TIP}/inertial/origin", "xyz", 1.001), "its centre of mass"),
    ("MJCF", scaled(f"{IP}/limit", "upper", 1.001), "index_ip_flex: a limit is"),
    ("MJCF", scaled(f"{IP}/limit", "effort", 1.001), "index_ip_flex: motors give"),
    ("MJCF", scaled(f"{IP}/origin", "xyz", 1.001), "index_distal lies elsewhere"),
    ("MJCF", attribute(f"{IP}/axis", "xyz", "0 -1 0"), "index_distal lies elsewhere"),
    ("MJCF", text("<worldbody>", "<worldbody><nonsense/>", MJCF), "MuJoCo refuses it"),
    ("transmission", entry(0, 1, 0.123), "thumb_m1 moves another way with thumb_mcp_abd"),
    ("transmission", entry(2, 2, 0.0), "singular"),
    ("transmission", text("thumb_mcp_flex", "pinky_mcp_flex", TABLE), "unknown joints: pinky"),
    ("transmission", text("thumb_m1, ", "", TABLE), "motors and joints make (11, 12)"),
    ("transmission", text("matrix:", "table:", TABLE), "lacks one of the keys"),
    ("transmission", text("matrix:", "matrix: [", TABLE), "is no YAML"),
    ("joint limits", text("max_velocity: .*", "max_velocity: 3.0", LIMITS), "max_velocity is 3"),
    ("joint limits", text("  ring_ip_flex:", "  ring_finger:", LIMITS), "ring_finger is no moving joint"),
]  # fmt: skip


def faults(package: Path) -> dict[str, list[str]]:
    """What each faulty check says."""
    return {
        row.check: [f"{fault.subject}: {fault.message}" for fault in row.faults]
        for row in check_description(package).rows
        if row.verdict == "faulty"
    }


def test_a_good_package_passes_every_check(package):
    rows = check_description(package).rows
    assert [(row.check, row.verdict) for row in rows if row.verdict != "good"] == []
    assert [row.check for row in rows] == ["readable", *(check.name for check in CHECKS)]


@pytest.mark.parametrize(
    ("check", "spoil", "words"), BROKEN, ids=lambda x: x if isinstance(x, str) else ""
)
def test_a_broken_package_is_told_by_the_right_check(package, check, spoil, words):
    spoil(package)
    found = faults(package)
    assert any(words in fault for fault in found.get(check, [])), found


def test_every_check_is_seen_to_fail():
    assert {check for check, _, _ in BROKEN} == {check.name for check in CHECKS}


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (text("<robot", "<robot <", URDF), "not XML"),
        (text("<robot name", "<machine name", URDF), "not XML"),
        (attribute(f"{TIP}/inertial/mass", "value", "heavy"), "value='heavy' of <mass> is no number"),
        (attribute(f"{TIP}/inertial/mass", "value", "nan"), "is not finite"),
        (attribute(f"{IP}/origin", "xyz", "0 0"), "xyz='0 0' of <origin> is not three numbers"),
        (without(f"{TIP}/inertial", "mass"), "link index_distal: <inertial> lacks <mass>"),
        (without(IP, "child"), "joint index_ip_flex: <joint> lacks <child>"),
        (without(f"{TIP}/visual/geometry", "mesh"), "a geometry holds one shape, not 0"),
    ],
)  # fmt: skip
def test_a_file_that_cannot_be_read_is_told_with_its_place(package, spoil, words):
    spoil(package)
    found = faults(package)
    assert found.keys() == {"readable"}
    assert words in found["readable"][0]
