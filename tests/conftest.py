"""What many tests share: clay's spec, its compiled formulas, its first hand and one finished build."""

from __future__ import annotations

import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from fpcad.model.state import pose_state
from fpcad.sample.space import DesignSpace, design_space
from fpcad.solve.attempt import Attempt, Workbench, attempt, open_workbench
from fpcad.spec.load import load_spec
from fpcad.spec.schema import Spec

Array = NDArray[np.float64]

CLAY = Path(__file__).parents[1] / "designs" / "clay.yaml"
BUILT_CANDIDATES = 8
BUILT_HAND = 0
"""The initial hand, at the centre of clay's box: it can surely be made, and making one takes a minute."""


DEAR_FIRST = (
    "tests/test_cli_making.py",  # makes `built_clay`, while the other process makes twenty hands
    "tests/benchmarks/test_parts_of_hands.py",
    "tests/look/test_explore.py",
    "tests/make/test_parts.py",
    "tests/look/test_own_metric.py",
)
"""Files of several minutes, so that no process is left alone with one of them at the end."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Dear files first; processes take files in this order where xdist leaves it as it is."""
    place = {name: number for number, name in enumerate(DEAR_FIRST)}
    items.sort(key=lambda item: place.get(item.nodeid.split("::")[0], len(place)))


@dataclass(frozen=True)
class FirstHand:
    """The hand that clay's sampling starts from, all of its poses solved."""

    named: Array  # (n_d,) [mm, deg]
    attempt: Attempt

    @property
    def design(self) -> Array:
        """Design vector (n_d,) [mm, rad]."""
        return self.attempt.design

    @property
    def states(self) -> dict[str, Array]:
        """State y of each pose [mm, rad]."""
        return {pose: solved.y for pose, solved in self.attempt.poses.items()}


@pytest.fixture(scope="session")
def clay() -> Spec:
    """Clay's spec."""
    return load_spec(CLAY)


@pytest.fixture(scope="session")
def kernel_cache(request: pytest.FixtureRequest) -> Path:
    """Folder of compiled formulas; it outlives the run and serves all of its processes."""
    assert request.config.cache is not None
    return request.config.cache.mkdir("kernels")


@pytest.fixture(scope="session")
def bench(clay: Spec, kernel_cache: Path) -> Workbench:
    """Clay with its compiled formulas; the first process compiles them, the others wait."""
    with exclusively(kernel_cache / "lock"):
        return open_workbench(clay, kernel_cache)


@pytest.fixture(scope="session")
def clay_space(clay: Spec) -> DesignSpace:
    """The box of clay's designs."""
    return design_space(clay.hand)


@pytest.fixture(scope="session")
def first_hand(bench: Workbench, clay_space: DesignSpace) -> FirstHand:
    """Clay's initial hand, solved from the states that the spec gives."""
    initial = bench.spec.initial
    assert initial is not None
    named = np.array([initial.design[name] for name in clay_space.names])
    states = {pose: pose_state(y, bench.template.names) for pose, y in initial.poses.items()}
    solved = attempt(bench, clay_space.internal(named), states)
    assert solved.succeeded
    return FirstHand(named, solved)


@pytest.fixture(scope="session")
def built_clay(
    clay: Spec, bench: Workbench, kernel_cache: Path, tmp_path_factory: pytest.TempPathFactory
) -> Path:
    """A finished build folder of clay with few candidates, the initial hand chosen of them.

    The first process that asks makes it; to the others, which wait, it is up to date. Asking for
    `bench` has its formulas compiled before, by one process alone.
    """
    from fpcad.pipeline.by_hand import choose_by_hand
    from fpcad.pipeline.run import is_current, run_stages
    from fpcad.pipeline.stage import Build

    sampling = clay.sampling.model_copy(update={"candidates": BUILT_CANDIDATES})
    spec = clay.model_copy(update={"sampling": sampling})
    root = _run_folder(tmp_path_factory)
    with exclusively(root / "builds.lock"):
        builds = root / "builds"
        if not builds.exists():
            builds.mkdir()
            (builds / ".kernels").symlink_to(kernel_cache, target_is_directory=True)
        build = Build(spec, builds / "clay", workers=1)
        if not is_current(build, "export"):
            run_stages(build, "select")
            assert choose_by_hand(build, BUILT_HAND) == BUILT_HAND
    return builds / "clay"


@contextmanager
def exclusively(lock: Path) -> Iterator[None]:
    """One process at a time, of all that name the same file."""
    with lock.open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


def _run_folder(factory: pytest.TempPathFactory) -> Path:
    """Temporary folder of this run, the same for all of its processes."""
    own = factory.getbasetemp()
    return own.parent if "PYTEST_XDIST_WORKER" in os.environ else own
