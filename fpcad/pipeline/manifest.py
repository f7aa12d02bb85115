"""manifest.json: what was made, from what, and how long it took."""

from __future__ import annotations

import platform
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

from fpcad.spec.dump import spec_hash
from fpcad.spec.schema import Spec
from fpcad.store import read_json, write_json

FILE = "manifest.json"
PACKAGES = ("fpcad", "casadi", "daqp", "numpy", "scipy", "cadquery")


def read_manifest(folder: Path) -> dict[str, Any]:
    """The manifest of a build folder; an empty one where there is none."""
    file = folder / FILE
    return read_json(file) if file.exists() else {"stages": {}}


def begin_manifest(folder: Path, spec: Spec, stages: dict[str, Any]) -> dict[str, Any]:
    """Write the manifest's head, keeping what is told of `stages`."""
    manifest = {
        "name": spec.name,
        "spec_sha256": spec_hash(spec),
        "seed": spec.sampling.seed,
        "versions": {package: version(package) for package in PACKAGES},
        "python": platform.python_version(),
        "stages": stages,
    }
    write_json(folder / FILE, manifest)
    return manifest


def record_stage(
    folder: Path, manifest: dict[str, Any], stage: str, record: dict[str, Any]
) -> None:
    """Write what is to be told of one stage."""
    manifest["stages"][stage] = {**record, "time": datetime.now(UTC).isoformat(timespec="seconds")}
    write_json(folder / FILE, manifest)
