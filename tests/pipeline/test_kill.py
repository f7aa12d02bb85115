"""A run that is killed at any moment and started again ends with the same files."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from fpcad.errors import StoreError
from fpcad.pipeline.run import run_stages
from fpcad.store import exclusive
from tests.pipeline.small import contents, small_build

ROOT = Path(__file__).parents[2]
KILLS = 5
NEVER = 0


def run(folder: Path, kernels: Path, moment: int) -> subprocess.CompletedProcess[str]:
    """Make the small design in another process, which is killed at a moment."""
    command = [sys.executable, "-m", "tests.pipeline.killed", folder, kernels, str(moment)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory, bench, kernel_cache) -> tuple[Path, int]:
    """A finished build, and how many moments it took."""
    folder = tmp_path_factory.mktemp("undisturbed")
    done = run(folder, kernel_cache, NEVER)
    assert done.returncode == 0, done.stderr
    return folder / "small", int(done.stdout)


def test_kills_leave_no_trace(tmp_path, kernel_cache, undisturbed):
    finished, moments = undisturbed
    for moment in np.random.default_rng(3).integers(1, moments // 2, KILLS):
        assert run(tmp_path, kernel_cache, moment).returncode == -signal.SIGKILL
    assert run(tmp_path, kernel_cache, NEVER).returncode == 0
    assert contents(tmp_path / "small") == contents(finished)


@pytest.mark.parametrize("workers", [2, 4])
def test_the_number_of_workers_changes_nothing(tmp_path, kernel_cache, undisturbed, workers):
    finished, _ = undisturbed
    run_stages(small_build(tmp_path, kernel_cache, workers), "select")
    assert contents(tmp_path / "small") == contents(finished)


def test_a_second_run_on_a_folder_is_refused(tmp_path, kernel_cache):
    build = small_build(tmp_path, kernel_cache)
    with (
        exclusive(build.folder),
        pytest.raises(StoreError, match="another fpcad is at work") as told,
    ):
        run_stages(build, "solve")
    assert len(str(told.value).splitlines()) == 1
