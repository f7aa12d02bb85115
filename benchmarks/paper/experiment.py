"""Running `fpcad select` for one experiment, and what that takes."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from fpcad.spec.dump import dump_spec
from fpcad.spec.load import load_spec
from fpcad.spec.schema import Spec
from fpcad.store import read_json, write_json, write_whole

ROOT = Path(__file__).parents[2]
RUNS = "experiment.json"
STAGES = ("solve", "sample", "evaluate", "select")
POLL_S = 0.5
KB_PER_MB = 1024


@dataclass(frozen=True)
class Experiment:
    """A design of designs/ with what is changed of its sampling."""

    design: str
    title: str
    variant: str = ""
    """Suffix of the build's name where sampling differs from the design's."""
    sampling: Mapping[str, float] = field(default_factory=dict)

    def spec(self, candidates: int | None) -> Spec:
        """The design's spec; with a number of `candidates` a trial under a name of its own."""
        spec = load_spec(ROOT / "designs" / f"{self.design}.yaml")
        changes = dict(self.sampling)
        suffix = self.variant
        if candidates is not None:
            changes["candidates"] = candidates
            suffix += f"-{candidates}"
        sampling = spec.sampling.model_copy(update=changes)
        return spec.model_copy(update={"name": spec.name + suffix, "sampling": sampling})


@dataclass(frozen=True)
class Peak:
    """Largest resident memory [MB] of the command itself and of any of its worker processes."""

    main_mb: float = 0.0
    worker_mb: float = 0.0

    def with_sample(self, main_mb: float, worker_mb: float) -> Peak:
        """The larger of both, one by one."""
        return Peak(max(self.main_mb, main_mb), max(self.worker_mb, worker_mb))


def run_experiment(spec: Spec, builds: Path, workers: int) -> Path:
    """Bring an experiment's build up to date with the command that users call; its folder.

    Progress bars of the command go to the terminal. Seconds and peak memory of each run that did
    anything are added to experiment.json of the build.
    """
    folder = builds / spec.name
    file = write_whole(folder / "experiment.yaml", dump_spec(spec))
    before, started, peak = _stage_times(folder), time.monotonic(), Peak()
    command = [sys.executable, "-m", "fpcad", "select", str(file), "--build", str(builds)]
    process = subprocess.Popen([*command, "--workers", str(workers)], cwd=ROOT)
    try:
        while process.poll() is None:
            peak = peak.with_sample(*_resident_mb(process.pid))
            time.sleep(POLL_S)
    finally:
        if process.poll() is None:
            process.terminate()
            process.wait()
        if _stage_times(folder) != before:
            _record(folder, workers, time.monotonic() - started, peak)
    if process.returncode != 0:
        raise SystemExit(f"{' '.join(command)} ended with code {process.returncode}")
    return folder


def runs(folder: Path) -> list[dict[str, Any]]:
    """Runs that made what the build now holds; empty where it was not made by this script."""
    file = folder / RUNS
    known = read_json(file) if file.exists() else []
    return [run for run in known if run["key"] == _key(folder)]


def _record(folder: Path, workers: int, seconds: float, peak: Peak) -> None:
    run = {
        "key": _key(folder),
        "workers": workers,
        "seconds": round(seconds, 1),
        "main_mb": round(peak.main_mb),
        "worker_mb": round(peak.worker_mb),
    }
    write_json(folder / RUNS, [*runs(folder), run])


def _manifest_stages(folder: Path) -> dict[str, Any]:
    file = folder / "manifest.json"
    return read_json(file)["stages"] if file.exists() else {}


def _stage_times(folder: Path) -> dict[str, str]:
    return {name: stage.get("time", "") for name, stage in _manifest_stages(folder).items()}


def _key(folder: Path) -> str:
    """Key of the sampled tree: runs before a change of code or spec do not count."""
    return str(_manifest_stages(folder).get("sample", {}).get("key", ""))


def _resident_mb(pid: int) -> tuple[float, float]:
    """Peak memory so far of a process and of the largest of its descendants."""
    return _high_water_mb(pid), max(map(_high_water_mb, _descendants(pid)), default=0.0)


def _high_water_mb(pid: int) -> float:
    """VmHWM of Linux; 0 for a process that has just ended, or where there is no /proc."""
    try:
        status = Path(f"/proc/{pid}/status").read_text(encoding="utf-8")
    except OSError:
        return 0.0
    lines = [line for line in status.splitlines() if line.startswith("VmHWM:")]
    return float(lines[0].split()[1]) / KB_PER_MB if lines else 0.0


def _descendants(pid: int) -> list[int]:
    found = []
    for child in _children(pid):
        found += [child, *_descendants(child)]
    return found


def _children(pid: int) -> list[int]:
    tasks = Path(f"/proc/{pid}/task")
    try:
        lists = [
            (tasks / task / "children").read_text(encoding="utf-8") for task in os.listdir(tasks)
        ]
    except OSError:
        return []
    return [int(child) for text in lists for child in text.split()]
