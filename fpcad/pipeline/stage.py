"""What a stage is: a part of the build with named inputs, run again only when they change."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Protocol

from fpcad.pipeline.hire import Hire, processes
from fpcad.solve.attempt import Workbench, open_workbench
from fpcad.spec.dump import spec_hash
from fpcad.spec.schema import Spec
from fpcad.store import Shards
from fpcad.wield.plugins import installed_metrics
from fpcad.workers import Workers, available_cores

PACKAGE = Path(__file__).parent.parent

PHYSICS = ("motion", "grip"), ("make", "simulate")
"""Sections and layers that trials in physics depend on."""

Counts = dict[str, int | float | str]
"""What a stage tells of itself in the manifest."""


class Progress(Protocol):
    """A stage's bar."""

    def advance(self, steps: int = 1, note: str = "") -> None:
        """Count finished steps; `note` says how it goes."""
        ...


class Reporter(Protocol):
    """Where stages tell what they do; the command line draws bars."""

    def stage(self, title: str, total: int | None) -> AbstractContextManager[Progress]:
        """Open a bar over `total` steps, or over an unknown number."""
        ...

    def note(self, text: str) -> None:
        """Tell one line."""
        ...


class SilentReporter:
    """Tells nothing."""

    def stage(self, title: str, total: int | None) -> AbstractContextManager[Progress]:
        """A bar that is not drawn."""
        return nullcontext(self)

    def advance(self, steps: int = 1, note: str = "") -> None:
        """Nothing."""

    def note(self, text: str) -> None:
        """Nothing."""


@dataclass
class Build:
    """One design's folder with everything that is made of its spec."""

    spec: Spec
    folder: Path
    """build/NAME."""
    workers: int = field(default_factory=available_cores)
    reporter: Reporter = field(default_factory=SilentReporter)
    keys: dict[str, str] = field(default_factory=dict)
    """Hash of each stage's inputs."""
    hire: Hire = processes
    """Where the workers come from."""
    _bench: Workbench | None = None

    @property
    def kernel_cache(self) -> Path:
        """Compiled formulas, shared by all designs of a build folder."""
        return self.folder.parent / ".kernels"

    @property
    def bench(self) -> Workbench:
        """Formulas of all poses, opened at first use."""
        if self._bench is None:
            opened = partial(open_workbench, self.spec, self.kernel_cache)
            with self.reporter.stage("compiling formulas", None):
                self._bench = opened()
        return self._bench

    def open_workers(self) -> Workers[Workbench]:
        """Workers that each hold the formulas, which are compiled here before."""
        _ = self.bench
        return self.hire(self.spec, self.kernel_cache, self.workers)

    def shards(self, stage: str) -> Shards:
        """Running results of a stage; their folder is named after its inputs' hash."""
        return Shards(self.folder / "store" / f"{stage}-{self.keys[stage][:12]}")


@dataclass(frozen=True)
class Stage:
    """A part of the build.

    Attributes:
        name: verb of the command line.
        sections: parts of the spec that the stage reads itself.
        layers: folders of the package whose code its results depend on.
        outputs: files in the build folder without which it is not up to date.
        run: makes the outputs and tells counts.
        edition: of the columns of its files; another one makes it again.
        plugins: whether its results depend on other packages' metrics.
        physics: whether a spec has it try hands in physics, which more of spec and code decide.
    """

    name: str
    sections: tuple[str, ...]
    layers: tuple[str, ...]
    outputs: tuple[str, ...]
    run: Callable[[Build], Counts]
    edition: int = 1
    plugins: bool = False
    physics: Callable[[Spec], bool] = lambda _: False

    def key(self, spec: Spec, before: str) -> str:
        """Hash of everything that the stage's results depend on: stages before, spec and code."""
        digest = hashlib.sha256()
        more = PHYSICS if self.physics(spec) else ((), ())
        sections, layers = (*self.sections, *more[0]), (*self.layers, *more[1])
        for text in (self.name, str(self.edition), before, spec_hash(spec, *sections)):
            digest.update(text.encode() + b"\0")
        for layer in layers:
            folder = PACKAGE / layer
            for source in sorted([*folder.rglob("*.py"), *folder.glob("page/report.*")]):
                digest.update(source.read_bytes())
        for metric in installed_metrics() if self.plugins else ():
            digest.update(metric.fingerprint().encode())
        return digest.hexdigest()
