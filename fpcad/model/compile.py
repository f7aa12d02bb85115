"""Compiled formulas: CasADi functions as machine code where a C compiler is at hand."""

from __future__ import annotations

import hashlib
import logging
import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Sequence
from functools import cache
from importlib import resources
from pathlib import Path

import casadi as ca
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
logger = logging.getLogger(__name__)

COMPILER_FLAGS = ("-O1", "-fPIC", "-shared")
"""No -march: a cache may travel with a build folder."""


class Kernel:
    """A function of dense vectors, called without allocation.

    Calling it fills and returns the same output arrays each time: copy what must outlive the next
    call. Matrices come out in CasADi's column order, so a transposed Jacobian is returned
    as a C-contiguous array of its own shape.
    """

    def __init__(self, function: ca.Function) -> None:
        self._buffer, self._evaluate = function.buffer()
        self._inputs = [np.zeros(function.size1_in(i)) for i in range(function.n_in())]
        self._outputs: list[Array] = []
        self.outputs: tuple[Array, ...] = ()
        for i, value in enumerate(self._inputs):
            self._buffer.set_arg(i, memoryview(value))
        for i in range(function.n_out()):
            rows, columns = function.size_out(i)
            flat = np.zeros(rows * columns)
            self._buffer.set_res(i, memoryview(flat))
            self._outputs.append(flat if columns == 1 else flat.reshape(columns, rows))
        self.outputs = tuple(self._outputs)

    def __call__(self, *values: Array | float) -> tuple[Array, ...]:
        for target, value in zip(self._inputs, values, strict=True):
            target[:] = value
        self._evaluate()
        return self.outputs


def dense_function(name: str, inputs: Sequence[ca.SX], outputs: Sequence[ca.SX]) -> ca.Function:
    """A function with shared subexpressions and dense outputs."""
    dense = [ca.densify(ca.SX(output)) for output in outputs]
    return ca.Function(name, list(inputs), dense, {"cse": True})


def jacobian_transposed(expression: ca.SX, variables: ca.SX) -> ca.SX:
    """Transposed Jacobian, which a :class:`Kernel` hands out as the Jacobian in C order."""
    return ca.jacobian(expression, variables).T


def load_function(build: Callable[[], ca.Function], name: str, key: str, cache: Path) -> ca.Function:
    """The function `build` states, from the cache where `key` was seen before.

    With a C compiler it is machine code, else CasADi's virtual machine interprets it.
    """
    library, formula = cache / f"{name}-{key}.so", cache / f"{name}-{key}.casadi"
    if library.exists():
        return ca.external(name, str(library))
    cache.mkdir(parents=True, exist_ok=True)
    if compiler() is not None:
        function = build()
        _write_beside(library, lambda path: _compile(function, path))
        return ca.external(name, str(library))
    if not formula.exists():
        function = build()
        _write_beside(formula, lambda path: function.save(str(path)))
    return ca.Function.load(str(formula))


@cache
def compiler() -> str | None:
    """Path of the C compiler (CC, else cc or gcc or clang); None, with a warning, without one."""
    names = [os.environ["CC"]] if os.environ.get("CC") else ["cc", "gcc", "clang"]
    found = next((path for name in names if (path := shutil.which(name))), None)
    if found is None:
        logger.warning(
            "no C compiler found (tried %s): formulas are interpreted, about ten times slower",
            ", ".join(names),
        )
    return found


def cache_key(*parts: str) -> str:
    """Name of what depends on `parts`, on the model's source code and on CasADi's version."""
    digest = hashlib.sha256()
    for source in sorted(resources.files("fpcad.model").iterdir(), key=lambda f: f.name):
        if source.name.endswith(".py"):
            digest.update(source.read_bytes())
    for part in (ca.__version__, " ".join(COMPILER_FLAGS), *parts):
        digest.update(b"\0" + part.encode())
    return digest.hexdigest()[:20]


def _compile(function: ca.Function, library: Path) -> None:
    with tempfile.TemporaryDirectory(dir=library.parent) as folder:
        generator = ca.CodeGenerator(function.name() + ".c")
        generator.add(function)
        source = generator.generate(folder + os.sep)
        command = [str(compiler()), *COMPILER_FLAGS, source, "-o", str(library), "-lm"]
        subprocess.run(command, check=True, capture_output=True, text=True)


def _write_beside(target: Path, write: Callable[[Path], None]) -> None:
    """Write to a neighbour and rename, so that two processes never see half a file."""
    handle, name = tempfile.mkstemp(dir=target.parent, suffix=target.suffix)
    os.close(handle)
    beside = Path(name)
    try:
        write(beside)
        beside.replace(target)
    finally:
        beside.unlink(missing_ok=True)
