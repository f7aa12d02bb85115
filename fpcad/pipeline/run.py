"""Running the stages up to one of them, skipping what is up to date."""

from __future__ import annotations

import shutil
import time
from typing import Any

from fpcad.pipeline.evaluate import EVALUATE
from fpcad.pipeline.export import EXPORT
from fpcad.pipeline.manifest import begin_manifest, read_manifest, record_stage
from fpcad.pipeline.report import REPORT
from fpcad.pipeline.sample import SAMPLE
from fpcad.pipeline.select import SELECT
from fpcad.pipeline.solve import SOLVE
from fpcad.pipeline.stage import Build, Stage
from fpcad.simulate.engine import mujoco
from fpcad.spec.dump import dump_spec
from fpcad.store import exclusive, write_whole

STAGES: tuple[Stage, ...] = (SOLVE, SAMPLE, EVALUATE, SELECT, EXPORT, REPORT)


def run_stages(build: Build, last: str, force: bool = False) -> dict[str, Any]:
    """Make everything up to the stage `last` and return the manifest.

    A stage whose inputs' hash is unchanged and whose outputs exist is skipped; a stage that was
    killed goes on from its finished shards. `force` makes the last stage again. No other process may
    be making the same folder.
    """
    if build.spec.selection.simulate:
        mujoco()  # whether it is there is told now, not after hours of sampling
    with exclusive(build.folder):
        return _run_stages(build, last, force)


def is_current(build: Build, stage: str) -> bool:
    """Whether a stage's files are those of this spec and this version; fills in `build.keys`."""
    records = read_manifest(build.folder)["stages"]
    _fill_keys(build)
    chosen = next(one for one in STAGES if one.name == stage)
    same = records.get(stage, {}).get("key") == build.keys[stage]
    return same and _up_to_date(build, chosen, records)


def _fill_keys(build: Build) -> None:
    before = ""
    for stage in STAGES:
        before = build.keys[stage.name] = stage.key(build.spec, before)


def _run_stages(build: Build, last: str, force: bool) -> dict[str, Any]:
    known = read_manifest(build.folder)["stages"]
    _fill_keys(build)
    valid = {
        stage.name: known[stage.name]
        for stage in STAGES
        if known.get(stage.name, {}).get("key") == build.keys[stage.name]
    }
    manifest = begin_manifest(build.folder, build.spec, valid)
    write_whole(build.folder / "spec.yaml", dump_spec(build.spec))
    for place, stage in enumerate(STAGES):
        if _up_to_date(build, stage, manifest["stages"]) and not (force and stage.name == last):
            build.reporter.note(f"{stage.name}: up to date")
        else:
            for later in STAGES[place:]:
                manifest["stages"].pop(later.name, None)
            _run(build, stage, manifest)
        if stage.name == last:
            break
    return manifest


def _up_to_date(build: Build, stage: Stage, records: dict[str, Any]) -> bool:
    done = records.get(stage.name, {}).get("status") == "done"
    return done and all((build.folder / output).exists() for output in stage.outputs)


def _run(build: Build, stage: Stage, manifest: dict[str, Any]) -> None:
    started, key = time.monotonic(), build.keys[stage.name]
    _remove_stale_shards(build, stage)
    record_stage(build.folder, manifest, stage.name, {"status": "running", "key": key})
    counts = stage.run(build)
    seconds = round(time.monotonic() - started, 3)
    record = {"status": "done", "key": key, "seconds": seconds, "counts": counts}
    record_stage(build.folder, manifest, stage.name, record)


def _remove_stale_shards(build: Build, stage: Stage) -> None:
    """Shards of inputs that are no longer the spec's."""
    current = build.shards(stage.name).folder
    for folder in current.parent.glob(f"{stage.name}-*"):
        if folder != current:
            shutil.rmtree(folder)
