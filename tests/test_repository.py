"""What no file of the repository may say, and what constraints.txt must."""

from __future__ import annotations

import ast
import re
import subprocess
import tomllib
from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest
from ruamel.yaml import YAML

ROOT = Path(__file__).parents[1]

# Put together here, so that this file does not hold what it looks for.
HOSTS = [
    ".".join(parts)
    for parts in (
        ("pypi", "org"),
        ("pythonhosted", "org"),
        ("anaconda", "org"),
        ("npmjs", "org"),
        ("npmjs", "com"),
        ("yarnpkg", "com"),
        ("crates", "io"),
        ("docker", "io"),
        ("ghcr", "io"),
        ("quay", "io"),
        ("golang", "org"),
        ("pytorch", "org"),
        ("debian", "org"),
        ("ubuntu", "com"),
        ("nodejs", "org"),
    )
]
FOLDERS = [rf"(?<![\w.~/-])/{name}/" for name in ("work", "root", "home", "Users", "opt", "mnt")]
SCRATCH = [r"/tmp/" + r"w\b", r"\bshared" + "/", r"\bissue " + r"#?\d"]
FORBIDDEN = re.compile("|".join([*map(re.escape, HOSTS), *FOLDERS, *SCRATCH]))

PIN = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]*==[0-9][A-Za-z0-9.!+]*")
REQUIREMENT = re.compile(r"[A-Za-z0-9._-]+")


def tracked_files() -> list[Path]:
    """Files that git tracks, without those that are deleted here."""
    command = ["git", "-c", "safe.directory=*", "ls-files", "-z"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    if listed.returncode:
        pytest.skip(f"no git repository here: {listed.stderr.strip()}")
    return [path for name in listed.stdout.split("\0") if name and (path := ROOT / name).is_file()]


def forbidden(text: str) -> list[str]:
    """What a text says and must not: registries, paths of one machine, notes to ourselves."""
    return [match.group() for match in FORBIDDEN.finditer(text)]


def said_words(source: str) -> set[str]:
    """Words of all string literals and names of a Python source; `_` parts words."""
    texts: list[str] = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            texts.append(node.value)
        texts += [v for _, v in ast.iter_fields(node) if isinstance(v, str)]
    return {word for text in texts for word in re.findall(r"[a-z0-9]+", text)}


def pose_names() -> set[str]:
    """Names of the poses of all designs of the repository."""
    specs = (ROOT / "designs").glob("*.yaml")
    return {pose for spec in specs for pose in YAML(typ="safe").load(spec)["poses"]}


def pins() -> list[str]:
    lines = (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines()
    return [line for line in lines if line and not line.startswith("#")]


def names(requirements: Iterable[str]) -> Iterator[str]:
    for requirement in requirements:
        match = REQUIREMENT.match(requirement)
        assert match, requirement
        yield re.sub(r"[-_.]+", "-", match.group()).lower()


def test_no_file_names_a_registry_a_machines_path_or_our_notes():
    said = {}
    for path in tracked_files():
        data = path.read_bytes()
        if b"\0" not in data and (found := forbidden(data.decode("utf-8"))):
            said[str(path.relative_to(ROOT))] = found
    assert said == {}


@pytest.mark.parametrize(
    "text",
    [
        "see https://files." + HOSTS[1] + "/packages",
        "cd /" + "work/main",
        "path = '/" + "root/x'",
        "/" + "tmp/w/v/bin/python",
        "../shared" + "/design.md",
        "as issue" + " 2 asks",
    ],
)
def test_what_must_not_be_said_is_found(text):
    assert forbidden(text)


@pytest.mark.parametrize("text", ["fpcad/" + "work/x.py", "a shared lock", "an issue was found"])
def test_ordinary_words_may_be_said(text):
    assert not forbidden(text)


def test_poses_are_data_that_no_module_knows():
    poses = pose_names()
    known = {
        str(path.relative_to(ROOT)): words
        for path in (ROOT / "fpcad").rglob("*.py")
        if (words := said_words(path.read_text(encoding="utf-8")) & poses)
    }
    assert known == {}


@pytest.mark.parametrize(
    "source",
    ["x = 'carve'", "x = f'{y}carve_tmr'", "carve_angle = 1", "def f(carve): ...", "x.carve"],
)
def test_a_pose_that_a_module_knows_is_found(source):
    assert "carve" in pose_names()
    assert "carve" in said_words(source)


def test_every_constraint_pins_one_version_and_names_no_address():
    assert pins()
    assert [line for line in pins() if not PIN.fullmatch(line)] == []


def test_no_package_is_pinned_twice():
    pinned = list(names(pins()))
    assert len(pinned) == len(set(pinned))


def test_every_requirement_is_pinned():
    with (ROOT / "pyproject.toml").open("rb") as file:
        settings = tomllib.load(file)
    project = settings["project"]
    wanted = [*project["dependencies"], *settings["build-system"]["requires"]]
    for extra in project["optional-dependencies"].values():
        wanted += extra
    assert set(names(wanted)) - {"fpcad"} <= set(names(pins()))
