"""Build folders with made-up numbers: as many hands as wanted, without solving a single pose."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pyarrow as pa

from fpcad.look.layout import layout_of
from fpcad.model.state import pose_state, state_columns
from fpcad.sample.space import design_space
from fpcad.select.choose import choose
from fpcad.select.ranking import rank_table
from fpcad.spec.dump import dump_spec
from fpcad.spec.schema import Spec
from fpcad.spec.templates import TEMPLATES
from fpcad.store import write_json, write_table, write_whole

STAGES = ("solve", "sample", "evaluate", "select")


def write_made_up_run(folder: Path, spec: Spec, n: int, states: int = 25, seed: int = 0) -> Path:
    """A finished run of n >= 1 hands, their designs all over the box, up to the stage `select`.

    Paths have `states` states a pose and sway about the spec's own initial poses.
    """
    random = np.random.default_rng(seed)
    write_whole(folder / "spec.yaml", dump_spec(spec))
    write_manifest(folder, dict.fromkeys(STAGES, "done"))
    candidates = made_up_candidates(spec, n, random)
    write_table(folder / "candidates.parquet", candidates)
    write_table(folder / "calls.parquet", made_up_calls(spec, candidates, random))
    metrics = rank_table(made_up_metrics(spec, n, random), list(spec.poses), spec.selection)
    write_table(folder / "metrics.parquet", metrics)
    choice = choose(metrics, spec.selection.rule)
    row = candidates.slice(choice.id, 1).to_pylist()[0]
    design = {name: row[name] for name in design_space(spec.hand).names}
    told = {"id": choice.id, "design": design, "rule": choice.rule, "reason": choice.reason}
    write_json(folder / "selected.json", told)
    kept = metrics.filter(metrics["pareto"])["id"].to_pylist()
    write_table(folder / "paths.parquet", made_up_paths(spec, candidates, kept, states, random))
    return folder


def write_manifest(folder: Path, stages: dict[str, str]) -> None:
    """A manifest that tells how far each stage came."""
    records = {stage: {"status": status, "key": stage * 4} for stage, status in stages.items()}
    told = {"name": folder.name, "versions": {"fpcad": "0.1.0"}, "stages": records}
    write_whole(folder / "manifest.json", json.dumps(told))


def made_up_candidates(spec: Spec, n: int, random: np.random.Generator) -> pa.Table:
    """n hands with designs all over the box and poses near the spec's initial ones."""
    space, names = design_space(spec.hand), TEMPLATES[spec.hand.template]
    designs = space.named(random.uniform(-0.5, 0.5, (n, int(space.free.sum()))))
    columns: dict[str, object] = {"id": np.arange(n), "parent": np.arange(n) - 1}
    columns |= dict(zip(space.names, designs.T, strict=True))
    assert spec.initial is not None
    for pose, initial in spec.initial.poses.items():
        y = pose_state(initial, names)
        near = y + random.normal(0.0, 0.02, (n, len(y)))
        columns |= dict(zip(state_columns(pose, names, layout_of(spec, pose)), near.T, strict=True))
    return pa.table(columns)


def made_up_calls(spec: Spec, candidates: pa.Table, random: np.random.Generator) -> pa.Table:
    """Calls of which about two in three are accepted, one for every hand but the first."""
    reasons, found = [], []
    for candidate in candidates["id"].to_pylist()[1:]:
        while random.random() < 1 / 3:
            reasons.append("too close")
            found.append(-1)
        reasons.append("")
        found.append(candidate)
    n, names = len(found), design_space(spec.hand).names
    numbers = {
        "number": np.arange(n),
        "parent": np.zeros(n, int),
        "candidate": np.array(found, int),
    }
    designs = {name: np.zeros(n) for name in names}
    outcomes = ["rejected" if reason else "accepted" for reason in reasons]
    words = {"outcome": pa.array(outcomes, pa.string()), "reason": pa.array(reasons, pa.string())}
    return pa.table({**numbers, **words, **designs})


def made_up_metrics(spec: Spec, n: int, random: np.random.Generator) -> pa.Table:
    """Metrics of n hands, all of them makeable."""
    scales = {"tmr_deg": 150, "mss_mm_s": 5, "mft_nmm": 9e3, "mft_p90_nmm": 8e3, "tip_force_n": 2}
    columns: dict[str, object] = {"id": np.arange(n)}
    for pose in spec.poses:
        for kind, scale in scales.items():
            columns[f"{pose}_{kind}"] = scale * random.uniform(0.1, 1.0, n)
        columns[f"{pose}_end_plus"] = columns[f"{pose}_end_minus"] = ["limits"] * n
    return pa.table({**columns, "makeable": np.ones(n, bool), "reason": [""] * n})


def made_up_paths(
    spec: Spec, candidates: pa.Table, kept: list[int], states: int, random: np.random.Generator
) -> pa.Table:
    """Paths of the kept hands: joints that sway with the tool's angle."""
    names, tables = TEMPLATES[spec.hand.template], []
    angles = np.linspace(-0.7, 1.3, states)
    angles[np.argmin(np.abs(angles))] = 0.0
    for pose in spec.poses:
        layout = layout_of(spec, pose)
        columns = state_columns(pose, names, layout)
        y = np.column_stack([candidates[c].to_numpy() for c in columns])[kept]
        sway = random.uniform(-0.3, 0.3, (len(kept), 1, layout.n_u)) * np.sin(angles)[:, None]
        joints = (y[:, None, layout.joints] + sway).reshape(-1, layout.n_u)
        contacts = np.repeat(y[:, layout.contacts], states, axis=0)
        n = len(joints)
        tables.append(
            pa.table(
                {
                    "id": np.repeat(kept, states),
                    "pose": [pose] * n,
                    "state": np.tile(np.arange(states), len(kept)),
                    "tool_angle_rad": np.tile(angles, len(kept)),
                    "joints_rad": _lists(joints),
                    "contacts_mm_rad": _lists(contacts),
                }
            )
        )
    return pa.concat_tables(tables).sort_by([("id", "ascending"), ("pose", "ascending")])


def _lists(values: np.ndarray) -> pa.Array:
    offsets = pa.array(np.arange(len(values) + 1, dtype=np.int32) * values.shape[1])
    return pa.ListArray.from_arrays(offsets, pa.array(values.ravel()))
