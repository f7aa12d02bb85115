"""Compiled formulas: CasADi functions as machine code where a C compiler is at hand."""

from __future__ import annotations

import hashlib
import logging
import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from importlib import resources
from multiprocessing import parent_process
from pathlib import Path

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from fpcad.errors import ToolchainError

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
        self.function = function
        self._buffer, self._evaluate = function.buffer()
        self._inputs = [np.zeros(function.size1_in(i)) for i in range(function.n_in())]
        self._outputs: list[Array] = []
        self.outputs: tuple[Array, ...] = ()
        for i, value in enumerate(self._inputs):
            self._buffer.set_arg(i, value.data)  # pyright: ignore[reportCallIssue]
        for i in range(function.n_out()):
            rows, columns = function.size_out(i)
            flat = np.zeros(rows * columns)
            self._buffer.set_res(i, flat.data)  # pyright: ignore[reportCallIssue]
            self._outputs.append(flat if columns == 1 else flat.reshape(columns, rows))
        self.outputs = tuple(self._outputs)

    def __call__(self, *values: Array | float) -> tuple[Array, ...]:
        for target, value in zip(self._inputs, values, strict=True):
            target[:] = value
        self._evaluate()
        return self.outputs

    @property
    def failed(self) -> bool:
        """Whether a solver inside the function found no solution in the last call."""
        return self._buffer.ret() != 0


def dense_function(name: str, inputs: Sequence[ca.SX], outputs: Sequence[ca.SX]) -> ca.Function:
    """A function with shared subexpressions and dense outputs."""
    dense = [ca.densify(ca.SX(output)) for output in outputs]
    return ca.Function(name, list(inputs), dense, {"cse": True})


def jacobian_transposed(expression: ca.SX, variables: ca.SX) -> ca.SX:
    """Transposed Jacobian, which a :class:`Kernel` hands out as the Jacobian in C order."""
    return ca.jacobian(expression, variables).T


def load_functions(
    builders: Mapping[str, Callable[[], ca.Function]], key: str, cache: Path
) -> dict[str, ca.Function]:
    """The functions that `builders` state, by name, from the cache where `key` was seen before.

    With a C compiler they become machine code, all at once on the cores there are; without one
    CasADi's virtual machine interprets them.
    """
    cache.mkdir(parents=True, exist_ok=True)
    suffix = "casadi" if compiler() is None else "so"
    files = {name: cache / f"{name}-{key}.{suffix}" for name in builders}
    missing = {name: build() for name, build in builders.items() if not files[name].exists()}
    if compiler() is None:
        for name, function in missing.items():
            _write_beside(files[name], lambda path, f=function: f.save(str(path)))
        return {name: ca.Function.load(str(file)) for name, file in files.items()}
    sources = {name: _c_source(function) for name, function in missing.items()}
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(lambda name: _compile(sources[name], files[name]), sources))
    return {name: ca.external(name, str(file)) for name, file in files.items()}


@cache
def compiler() -> str | None:
    """Path of the C compiler (CC, else cc or gcc or clang); None, with a warning, without one."""
    names = [os.environ["CC"]] if os.environ.get("CC") else ["cc", "gcc", "clang"]
    found = next((path for name in names if (path := shutil.which(name))), None)
    if found is None and parent_process() is None:  # workers need not say it again
        logger.warning(
            "no C compiler found (tried %s): formulas are interpreted, about ten times slower",
            ", ".join(names),
        )
    return found


def cache_key(*parts: str) -> str:
    """Name of what depends on `parts`, on the model's source code and on CasADi's version."""
    digest = hashlib.sha256()
    package = resources.files("fpcad")
    model = (f for f in package.joinpath("model").iterdir() if f.name.endswith(".py"))
    below = (package.joinpath("units.py"), package.joinpath("spec", "templates.py"))
    for source in (*sorted(model, key=lambda f: f.name), *below):
        digest.update(source.read_bytes())
    for part in (ca.CasadiMeta.version(), " ".join(COMPILER_FLAGS), *parts):
        digest.update(b"\0" + part.encode())
    return digest.hexdigest()[:20]


def _c_source(function: ca.Function) -> str:
    generator = ca.CodeGenerator(function.name() + ".c")
    generator.add(function)
    return generator.dump()


def _compile(source: str, library: Path) -> None:
    command = [str(compiler()), *COMPILER_FLAGS, "-x", "c", "-", "-lm", "-o"]

    def run(path: Path) -> None:
        done = subprocess.run([*command, str(path)], input=source, capture_output=True, text=True)
        if done.returncode != 0:
            raise ToolchainError(
                f"{command[0]} cannot compile formulas: {_first_line(done.stderr)}; install the C "
                "library's headers (libc6-dev on Debian and Ubuntu), or name another compiler in CC"
            )

    _write_beside(library, run)


def _first_line(text: str) -> str:
    return next(iter(text.strip().splitlines()), "it says nothing")


def _write_beside(target: Path, write: Callable[[Path], None]) -> None:
    """Write to a neighbour and rename, so that two processes never see half a file."""
    handle, name = tempfile.mkstemp(dir=target.parent, suffix=target.suffix)
    os.close(handle)
    beside = Path(name)
    try:
        write(beside)
        beside.chmod(0o644)  # mkstemp's files are their owner's alone, and a cache may be shared
        beside.replace(target)
    finally:
        beside.unlink(missing_ok=True)
