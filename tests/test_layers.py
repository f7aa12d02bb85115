"""The house's order: a module imports only its own layer and those before it, and never in a circle."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

ORDER = ("spec", "model", "solve", "sample", "wield", "select", "make", "simulate", "run")
COMMON = {"", "errors", "units"}  # "" is the package itself
SUPPORT = {"store", "workers", "progress"}
TOP = {"cli", "commands", "pipeline", "__main__"}
STRANGERS = {"check_description"}  # they read files as anybody could, and know nothing of fpcad
LOOK_MAY = {"look", "spec", "model", "sample", "wield", "select", "store", "errors", "units"}
SELECT_MAY = {*COMMON, "spec", "select"}  # it ranks tables that it is given


def sources() -> dict[str, str]:
    """Source of every module of the package by its dotted name."""
    modules = {}
    for path in sorted((ROOT / "fpcad").rglob("*.py")):
        parts = path.relative_to(ROOT).with_suffix("").parts
        name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
        modules[name] = path.read_text(encoding="utf-8")
    return modules


def imports(name: str, source: str, modules: Mapping[str, str]) -> Iterator[str]:
    """Modules of the package that a module names in an import, at any depth of its source."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if _in_package(alias.name))
        elif isinstance(node, ast.ImportFrom):
            base = _absolute(name, node, modules)
            if _in_package(base):
                for alias in node.names:
                    member = f"{base}.{alias.name}"
                    yield member if member in modules else base


def layer(module: str) -> str:
    """First part of a module's name below the package."""
    return [*module.split("."), ""][1]


def may_import(importer: str) -> set[str]:
    """Layers that a layer may import."""
    if importer in TOP or not importer:  # the package's own face shows a few names of all layers
        return {*TOP, "look", *STRANGERS, *ORDER, *SUPPORT, *COMMON}
    if importer in COMMON:
        return COMMON
    if importer in SUPPORT | STRANGERS:
        return {importer, *COMMON}
    if importer == "select":
        return SELECT_MAY
    if importer == "look":  # it reads what the stages left, and runs none of them
        return LOOK_MAY
    if importer in ORDER:
        return {*ORDER[: ORDER.index(importer) + 1], *SUPPORT, *COMMON}
    return set()


def faults(modules: Mapping[str, str]) -> list[str]:
    """Every import against the order, and a circle if there is one; each in one line."""
    found, graph = [], {}
    for name, source in modules.items():
        own = layer(name)
        if not may_import(own):
            found.append(f"{name} belongs to no layer; the order is {', '.join(ORDER)}")
        graph[name] = set(imports(name, source, modules)) - {name}
        found += [
            f"{name} imports {target}"
            for target in sorted(graph[name])
            if may_import(own) and layer(target) not in may_import(own)
        ]
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        found.append(f"circle: {' -> '.join(error.args[1])}")
    return found


def _in_package(module: str) -> bool:
    return module == "fpcad" or module.startswith("fpcad.")


def _absolute(importer: str, node: ast.ImportFrom, modules: Mapping[str, str]) -> str:
    if not node.level:
        return node.module or ""
    is_package = any(name.startswith(f"{importer}.") for name in modules)
    parts = importer.split(".")
    parents = parts[: len(parts) - node.level + is_package]
    return ".".join([*parents, *([node.module] if node.module else [])])


def test_the_package_keeps_the_order():
    assert faults(sources()) == []


def test_the_package_has_all_layers():
    assert {layer(name) for name in sources()} >= set(ORDER)


@pytest.mark.parametrize(
    ("module", "source", "fault"),
    [
        ("fpcad.spec.bad", "import fpcad.model.hand", "fpcad.spec.bad imports fpcad.model.hand"),
        ("fpcad.solve.bad", "from fpcad.run.link import Link", "fpcad.solve.bad imports fpcad.run.link"),
        ("fpcad.model.bad", "from fpcad import run", "fpcad.model.bad imports fpcad.run"),
        ("fpcad.model.bad", "from ..run import link", "fpcad.model.bad imports fpcad.run.link"),
        ("fpcad.sample.bad", "def f():\n    import fpcad.wield.path", "fpcad.sample.bad imports fpcad.wield.path"),
        ("fpcad.select.bad", "import fpcad.model.hand", "fpcad.select.bad imports fpcad.model.hand"),
        ("fpcad.select.bad", "import fpcad.store", "fpcad.select.bad imports fpcad.store"),
        ("fpcad.make.bad", "from fpcad.cli import main", "fpcad.make.bad imports fpcad.cli"),
        ("fpcad.look.bad", "import fpcad.pipeline.run", "fpcad.look.bad imports fpcad.pipeline.run"),
        ("fpcad.look.bad", "import fpcad.solve.attempt", "fpcad.look.bad imports fpcad.solve.attempt"),
        ("fpcad.check_description.bad", "import fpcad.spec.tool", "fpcad.check_description.bad imports fpcad.spec.tool"),
        ("fpcad.workers", "import fpcad.spec.tool", "fpcad.workers imports fpcad.spec.tool"),
        ("fpcad.errors", "import fpcad.spec.tool", "fpcad.errors imports fpcad.spec.tool"),
        ("fpcad.attic.bad", "import math", "fpcad.attic.bad belongs to no layer; the order is " + ", ".join(ORDER)),
    ],
)  # fmt: skip
def test_an_import_against_the_order_is_found(module, source, fault):
    others = ("fpcad", "fpcad.run", "fpcad.run.link", "fpcad.model.hand", "fpcad.spec.tool")
    later = ("fpcad.pipeline.run", "fpcad.solve.attempt")
    modules = dict.fromkeys((*others, *later, "fpcad.store", "fpcad.cli", "fpcad.wield.path"), "")
    assert faults({**modules, module: source}) == [fault]


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("fpcad.model.good", "from fpcad.spec.tool import CylinderTool\nimport numpy"),
        ("fpcad.make.good", "from fpcad.store import write\nfrom fpcad.errors import StoreError"),
        (
            "fpcad.select.good",
            "from .scores import score\nfrom fpcad.spec.process import Selection",
        ),
        ("fpcad.cli", "from fpcad import pipeline\nfrom fpcad.run import stream"),
        ("fpcad.make.good", "import fpcadette.cli"),
    ],
)
def test_an_import_in_order_is_allowed(module, source):
    assert faults({"fpcad.select.scores": "", module: source}) == []


def test_a_circle_is_found():
    modules = {
        "fpcad.model.a": "from fpcad.model.b import x",
        "fpcad.model.b": "def f():\n    from fpcad.model import c",
        "fpcad.model.c": "import fpcad.model.a",
    }
    assert len(found := faults(modules)) == 1
    assert found[0].startswith("circle: ")
