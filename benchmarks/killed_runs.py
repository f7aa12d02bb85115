"""Kill a run at random moments, go on, and compare with an undisturbed one. docs/scale.md.

    python -m benchmarks.killed_runs [--kills 20] [--candidates 500] [--workers 2]

Every run is killed once with SIGKILL: odd ones at a step of writing a file (half of those are
renames), even ones at a random time. Then the same command makes the rest, and all files are compared
bit for bit, times in manifest.json aside. The design is clay with coarser paths (5 deg a step).
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from ruamel.yaml import YAML

ROOT = Path(__file__).parents[1]
NEVER = 0
MARK = "FPCAD_KILLED_RUN"


def main() -> None:
    options = read_options()
    with tempfile.TemporaryDirectory(prefix="fpcad-kills-") as folder:
        root = Path(folder)
        spec = write_spec(root, options.candidates)
        if options.kernels:
            shutil.copytree(options.kernels, root / "undisturbed" / ".kernels")
        seconds, steps = time_run(root / "undisturbed", spec, options.workers)
        print(f"undisturbed: {seconds:.0f} s, {steps} steps of writing files", flush=True)
        finished = contents(root / "undisturbed")
        random, same = np.random.default_rng(options.seed), 0
        for kill in range(options.kills):
            victim = root / f"kill-{kill}"
            while not (
                told := kill_once(victim, spec, options.workers, kill, random, seconds, steps)
            ):
                shutil.rmtree(victim)  # it had ended before, as the machine has less to do by now
            orphans = left_over(victim.name)
            run(victim, spec, options.workers, NEVER).wait()
            equal = contents(victim) == finished
            same += equal and not orphans
            print(
                f"{kill + 1}: {told}; {'identical' if equal else 'DIFFERENT'}, {orphans} orphans",
                flush=True,
            )
            shutil.rmtree(victim)
        print(f"{same} of {options.kills} identical")
        sys.exit(same != options.kills)


def read_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="Kill runs and compare.")
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--candidates", type=int, default=500)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--kernels", type=Path, help="folder of compiled formulas to begin with")
    parser.add_argument("--seed", type=int, default=1)
    return parser.parse_args()


def write_spec(root: Path, candidates: int) -> Path:
    yaml = YAML()
    spec = yaml.load((ROOT / "designs" / "clay.yaml").read_text(encoding="utf-8"))
    spec["sampling"]["candidates"] = candidates
    spec["path"].update(step_deg=5, end_tolerance_deg=1)
    with (root / "clay.yaml").open("w", encoding="utf-8") as file:
        yaml.dump(spec, file)
    return root / "clay.yaml"


def run(folder: Path, spec: Path, workers: int, step: int) -> subprocess.Popen[str]:
    """Start a run; it kills itself at a step of writing files, where one is given."""
    command = [sys.executable, "-m", "benchmarks.kill_at_step", str(step), "select", str(spec)]
    return subprocess.Popen(
        [*command, "--build", str(folder), "--workers", str(workers)],
        cwd=ROOT,
        env={**os.environ, MARK: folder.name},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )


def time_run(folder: Path, spec: Path, workers: int) -> tuple[float, int]:
    """Seconds of an undisturbed run whose formulas are compiled, and its number of steps."""
    run(folder, spec, workers, NEVER).wait()
    shutil.rmtree(folder / "clay")
    began = time.monotonic()
    _, said = (process := run(folder, spec, workers, NEVER)).communicate()
    if process.returncode:
        raise RuntimeError(said)
    return time.monotonic() - began, int(said.splitlines()[-1])


def kill_once(
    folder: Path,
    spec: Path,
    workers: int,
    kill: int,
    random: np.random.Generator,
    seconds: float,
    steps: int,
) -> str:
    """Start a run that is killed once, and tell when; nothing if it ended before that."""
    folder.mkdir()
    shutil.copytree(folder.parent / "undisturbed" / ".kernels", folder / ".kernels")
    if kill % 2:
        step = int(random.integers(1, steps))
        process = run(folder, spec, workers, step)
        told = f"killed at step {step} of writing files"
    else:
        after = float(random.uniform(0.1, 0.95) * seconds)
        process = run(folder, spec, workers, NEVER)
        time.sleep(after)
        process.kill()
        told = f"killed after {after:.1f} s"
    process.communicate()
    return told if process.returncode == -signal.SIGKILL else ""


def left_over(mark: str) -> int:
    """Processes of a run that are still there two seconds after its end."""
    time.sleep(2)
    count = 0
    for environment in Path("/proc").glob("[0-9]*/environ"):
        try:
            count += f"{MARK}={mark}\0".encode() in environment.read_bytes()
        except OSError:
            continue  # it ended just now
    return count


def contents(folder: Path) -> dict[str, bytes | dict]:
    """All that a build holds, times aside."""
    build = folder / "clay"
    read: dict[str, bytes | dict] = {
        str(file.relative_to(build)): file.read_bytes()
        for file in sorted(build.rglob("*"))
        if file.is_file()
    }
    manifest = json.loads((build / "manifest.json").read_text())
    for record in manifest["stages"].values():
        del record["time"], record["seconds"]
    return {**read, "manifest.json": manifest}


if __name__ == "__main__":
    main()
