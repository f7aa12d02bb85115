"""Stage export: parts, description and trajectories of the chosen hand."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict
from functools import partial
from pathlib import Path

from fpcad.errors import MakeError
from fpcad.make.documents.stamp import Stamp
from fpcad.make.gripping import gripping_trajectory
from fpcad.make.hand import make_hand
from fpcad.make.parts.assembly import Progress
from fpcad.make.survive import survival, told
from fpcad.make.trajectory import Trajectory
from fpcad.make.trajectory_file import write_trajectory
from fpcad.model.geometry import HandGeometry, hand_geometry
from fpcad.pipeline.apart import run_apart
from fpcad.pipeline.evaluate import FILE as METRICS_FILE
from fpcad.pipeline.finished import chosen_design
from fpcad.pipeline.paths import drop_spare_paths, read_paths
from fpcad.pipeline.select import METRICS, SELECTED, refuse
from fpcad.pipeline.stage import Build, Counts, Stage
from fpcad.spec.dump import spec_hash
from fpcad.spec.schema import Spec
from fpcad.store import json_text, read_json, read_table

GRIP, SURVIVAL = "grip.json", "survival.json"
FOLDERS = "parts", "hand"
"""All files in there are of one hand."""
CAD_LIMIT_S = 900
"""Processor time of a hand's CAD; one takes some 100 s, and the CAD kernel may never end."""
PART_STEPS = 24
"""About how many steps `make_hand` tells, for the bar."""


def export(build: Build) -> Counts:
    """Write everything that is printed, simulated or run of the chosen hand.

    A hand that cannot be made is refused with its reason, and the next best is chosen.
    """
    while True:
        chosen = int(read_json(build.folder / SELECTED)["id"])
        try:
            files = _export_chosen(build)
        except MakeError as error:
            build.reporter.note(f"hand {chosen} cannot be made: {error}")
            refuse(build, chosen, str(error))
        else:
            drop_spare_paths(build)
            return {"files": files, "selected": chosen, "refused": _refused(build)}


def _refused(build: Build) -> int:
    """Hands that were evaluated and could not be made, those of a run that was killed among them."""
    evaluated, makeable = (
        sum(read_table(build.folder / file)["makeable"].to_pylist())
        for file in (METRICS_FILE, METRICS)
    )
    return evaluated - makeable


def _export_chosen(build: Build) -> int:
    """Write the chosen hand's files and count them."""
    chosen = int(read_json(build.folder / SELECTED)["id"])
    design = chosen_design(build.spec, build.folder)
    geometry = hand_geometry(build.bench.template, design)
    stamp = Stamp(build.spec.name, chosen, spec_hash(build.spec))
    trajectories, margins, paths = {}, {}, read_paths(build, chosen)
    with build.reporter.stage("trajectories", len(build.spec.poses)) as bar:
        for path in paths.values():
            trajectory, margins[path.pose] = gripping_trajectory(
                build.bench, design, geometry, path
            )
            trajectories[path.pose] = trajectory
            write_trajectory(trajectory, build.folder / "trajectories" / f"{path.pose}.json", stamp)
            bar.advance(1, f"{path.pose}: {trajectory.duration_s:.1f} s")
    stamp.write(
        build.folder / GRIP, json_text({pose: asdict(told) for pose, told in margins.items()})
    )
    with build.reporter.stage("parts", PART_STEPS) as bar:
        progress = partial(bar.advance, 1)
        order = build.spec, geometry, build.folder, trajectories, chosen
        files = run_apart(_make, order, CAD_LIMIT_S, progress)
    drop_others(files, *(build.folder / folder for folder in FOLDERS))
    with build.reporter.stage("errors of print and joints", None):
        figures = survival(build.bench, design, paths.values())
    stamp.write(build.folder / SURVIVAL, json_text(figures))
    for line in told(figures):
        build.reporter.note(line)
    return len(files) + len(build.spec.poses) + 2


def _make(
    tell: Progress, order: tuple[Spec, HandGeometry, Path, dict[str, Trajectory], int]
) -> list[Path]:
    spec, geometry, folder, trajectories, chosen = order
    return make_hand(spec, geometry, folder, tell, trajectories, chosen)


def drop_others(files: Iterable[Path], *folders: Path) -> None:
    """Remove what an earlier export left in the folders: another hand's parts must not be printed."""
    kept = set(files)
    for folder in folders:
        for path in sorted(folder.rglob("*"), reverse=True):
            if path.is_file() and path not in kept:
                path.unlink()
            elif path.is_dir() and not any(path.iterdir()):
                path.rmdir()


EXPORT = Stage(
    "export",
    ("name", "motors", "motion", "grip", "print", "mount"),
    ("make",),
    ("hand/transmission.yaml", "parts/bom.csv", "trajectories", GRIP, SURVIVAL),
    export,
)
