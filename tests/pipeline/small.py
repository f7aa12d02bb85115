"""A design that is made in seconds: clay's first pose, coarse paths, few hands."""

from __future__ import annotations

import json
from pathlib import Path

from fpcad.pipeline.stage import Build
from fpcad.spec.load import load_spec
from fpcad.spec.schema import Spec

CLAY = Path(__file__).parents[2] / "designs" / "clay.yaml"
HANDS = 40


def small_spec() -> Spec:
    """Clay with one pose; several shards in each stage."""
    clay = load_spec(CLAY)
    assert clay.initial is not None
    name, pose = next(iter(clay.poses.items()))
    initial = clay.initial.model_copy(update={"poses": {name: clay.initial.poses[name]}})
    sampling = clay.sampling.model_copy(update={"candidates": HANDS, "batch": 2})
    path = clay.path.model_copy(update={"step_deg": 5.0, "end_tolerance_deg": 1.0})
    changed = {"poses": {name: pose}, "initial": initial, "sampling": sampling, "path": path}
    return clay.model_copy(update=changed)


def small_build(root: Path, kernels: Path, workers: int = 1, **options) -> Build:
    """The small design's build in a folder of its own, with formulas that are compiled already."""
    root.mkdir(parents=True, exist_ok=True)
    if not (root / ".kernels").exists():
        (root / ".kernels").symlink_to(kernels, target_is_directory=True)
    return Build(small_spec(), root / "small", workers, **options)


def contents(folder: Path) -> dict[str, bytes | dict]:
    """All that a build folder holds, times aside."""
    files = {str(f.relative_to(folder)): f for f in sorted(folder.rglob("*")) if f.is_file()}
    read: dict[str, bytes | dict] = {name: file.read_bytes() for name, file in files.items()}
    manifest = json.loads(files["manifest.json"].read_text())
    for record in manifest["stages"].values():
        del record["time"], record["seconds"]
    return {**read, "manifest.json": manifest}
