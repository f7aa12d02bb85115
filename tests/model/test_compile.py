"""Machine code and interpreted formulas say the same, and processes share one cache."""

from __future__ import annotations

import logging
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import casadi as ca
import numpy as np
import pytest

from fpcad.errors import ToolchainError
from fpcad.model import compile as compiling
from fpcad.model.compile import (
    Kernel,
    cache_key,
    dense_function,
    jacobian_transposed,
    load_functions,
)
from fpcad.model.kernels import load_kernels
from fpcad.solve.attempt import Workbench
from fpcad.spec.schema import Spec
from tests.model.plain_hand import Array
from tests.model.postures import random_posture

KERNELS = ("constraints", "rates", "statics", "residual")


@pytest.fixture
def fresh_compiler() -> Iterator[None]:
    """The compiler is looked for again, in this test and after it."""
    compiling.compiler.cache_clear()
    yield
    compiling.compiler.cache_clear()


@pytest.fixture
def no_compiler(monkeypatch: pytest.MonkeyPatch, fresh_compiler: None) -> None:
    """A machine without a C compiler."""
    monkeypatch.setenv("CC", "/nonexistent")


def quadratic() -> ca.Function:
    """(x (2,), p) -> p x'x, its gradient and a matrix."""
    x, p = ca.SX.sym("x", 2), ca.SX.sym("p")
    rows = ca.vertcat(x[0] * x[1], x[0] ** 2, p * x[1])
    outputs = [p * ca.sumsqr(x), ca.gradient(p * ca.sumsqr(x), x), jacobian_transposed(rows, x)]
    return dense_function("quadratic", [x, p], outputs)


def quadratic_jacobian(x: Array, p: float) -> Array:
    return np.array([[x[1], x[0]], [2 * x[0], 0.0], [0.0, p]])


def values(kernel: Kernel, *inputs: Array | float) -> Array:
    return np.concatenate([output.ravel() for output in kernel(*inputs)])


@pytest.mark.usefixtures("no_compiler")
def test_interpreted_formulas_are_the_compiled_ones(
    bench: Workbench, clay: Spec, tmp_path: Path, caplog: pytest.LogCaptureFixture
):
    with caplog.at_level(logging.WARNING):
        interpreted = load_kernels(clay, "press", tmp_path)
    assert "no C compiler found (tried /nonexistent)" in caplog.text
    assert not list(tmp_path.glob("*.so"))
    for seed in range(3):
        at = random_posture(clay, "press", seed)
        for name in KERNELS:
            on_path = name in ("rates", "statics")
            inputs = (at.d, at.h, at.turn, at.x) if on_path else (at.d, at.turn, at.y)
            ours = values(getattr(bench.kernels["press"], name), *inputs)
            theirs = values(getattr(interpreted, name), *inputs)
            assert np.allclose(ours, theirs, rtol=1e-12, atol=1e-12 * np.abs(ours).max())


@pytest.mark.usefixtures("no_compiler")
def test_interpreted_formulas_are_read_back(tmp_path: Path):
    first = load_functions({"f": quadratic}, "key", tmp_path)["f"]
    again = load_functions({"f": pytest.fail}, "key", tmp_path)["f"]  # not built a second time
    x = np.array([2.0, 3.0])
    assert np.array_equal(values(Kernel(first), x, 4.0), values(Kernel(again), x, 4.0))


def test_compiled_formulas_are_read_back(tmp_path: Path):
    load_functions({"quadratic": quadratic}, "key", tmp_path)
    again = load_functions({"quadratic": pytest.fail}, "key", tmp_path)["quadratic"]
    value, gradient, jacobian = Kernel(again)(np.array([2.0, 3.0]), 4.0)
    assert value.tolist() == [52.0] and gradient.tolist() == [16.0, 24.0]
    assert jacobian.tolist() == quadratic_jacobian(np.array([2.0, 3.0]), 4.0).tolist()
    assert [file.name for file in tmp_path.iterdir()] == ["quadratic-key.so"]


def test_a_kernel_overwrites_its_last_answer():
    kernel = Kernel(quadratic())
    first = kernel(np.array([1.0, 0.0]), 1.0)
    kept = [value.copy() for value in first]
    second = kernel(np.array([0.0, 2.0]), 1.0)
    assert all(a is b for a, b in zip(first, second, strict=True))
    assert kept[0].tolist() == [1.0] and first[0].tolist() == [4.0]


def test_a_kernel_takes_exactly_its_inputs():
    kernel = Kernel(quadratic())
    with pytest.raises(ValueError, match="shorter"):
        kernel(np.zeros(2))
    with pytest.raises(ValueError, match="broadcast"):
        kernel(np.zeros(3), 1.0)


def test_the_key_tells_parts_apart():
    assert cache_key("a", "b") == cache_key("a", "b")
    assert len({cache_key("a", "b"), cache_key("ab"), cache_key("b", "a"), cache_key("a")}) == 4


@pytest.mark.usefixtures("fresh_compiler")
def test_a_compiler_that_fails_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    broken = tmp_path / "broken-cc"
    broken.write_text("#!/bin/sh\necho 'math.h: no such file' >&2\nexit 1\n")
    broken.chmod(0o755)
    monkeypatch.setenv("CC", str(broken))
    cache = tmp_path / "cache"
    with pytest.raises(
        ToolchainError, match=r"broken-cc cannot compile formulas: math\.h: no such"
    ):
        load_functions({"quadratic": quadratic}, "key", cache)
    assert list(cache.iterdir()) == []


FILLER = """
import sys, time
from pathlib import Path
import numpy as np
from fpcad.model.compile import Kernel, load_functions
from tests.model.test_compile import quadratic

cache, ready, go = (Path(argument) for argument in sys.argv[1:])
ready.touch()
while not go.exists():
    time.sleep(0.001)
function = load_functions({"quadratic": quadratic}, "key", cache)["quadratic"]
print(Kernel(function)(np.array([2.0, 3.0]), 4.0)[0][0])
"""


def test_processes_may_fill_one_cache_at_the_same_time(tmp_path: Path):
    cache, go = tmp_path / "cache", tmp_path / "go"
    ready = [tmp_path / f"ready{i}" for i in range(2)]
    environment = os.environ | {"PYTHONPATH": str(Path(__file__).parents[2])}
    fillers = [
        subprocess.Popen(
            [sys.executable, "-c", FILLER, str(cache), str(mark), str(go)],
            stdout=subprocess.PIPE,
            text=True,
            env=environment,
        )
        for mark in ready
    ]
    while not all(mark.exists() for mark in ready):
        assert all(filler.poll() is None for filler in fillers)
    go.touch()
    answers = [filler.communicate(timeout=60)[0].strip() for filler in fillers]
    assert answers == ["52.0", "52.0"]
    assert [file.name for file in cache.iterdir()] == ["quadratic-key.so"]
