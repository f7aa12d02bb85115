"""One compact document of a run: everything that the page draws."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fpcad.look.columns import Column
from fpcad.look.curves import efficiency, range_shares
from fpcad.look.groups import clusters, design_map, representatives
from fpcad.look.hands import HandDimensions, hand_dimensions
from fpcad.look.holding import HoldingForces
from fpcad.look.kept import MAX_EXACT, exact_paths, thin_paths
from fpcad.look.layout import layout_of
from fpcad.look.logs import RunLog
from fpcad.look.meshes import chosen_meshes
from fpcad.look.pack import Packer
from fpcad.look.poses import pose_states
from fpcad.look.run import Run
from fpcad.select.columns import flags, numbers
from fpcad.select.scores import MEAN_SCORE
from fpcad.spec.hand import PalmCapsule
from fpcad.spec.templates import TEMPLATES
from fpcad.units import RAD_PER_DEG

Array = NDArray[np.float64]
Told = dict[str, Any]

FORMAT = 3

OPENING, HANDS, PATHS = "opening", "hands", "paths"
"""Blocks in the order of the page: figures and the chosen hand; every hand in 3D; other paths."""


def build_document(run: Run, logs: Sequence[RunLog] = ()) -> tuple[Told, dict[str, str]]:
    """What the page shows, and the blocks of numbers that it refers to.

    The page draws from the first block while the browser still reads the others.

    Args:
        run: the run.
        logs: runs of its hand on motors.

    Returns:
        JSON values with references into the blocks, and each block in base64, the first one first;
        see :class:`fpcad.look.pack.Packer`.
    """
    pack, hands, paths = Packer(OPENING, plain=True), Packer(HANDS), Packer(PATHS)
    labels = clusters(run.space.standardize(run.designs))
    merit = numbers(run.table, MEAN_SCORE)
    chosen_row = _chosen_row(run)
    leaders = representatives(labels, merit, run.front)
    first = [] if chosen_row is None else [chosen_row]
    shown = first + [int(row) for row in leaders if row != chosen_row]
    document = {
        "format": FORMAT,
        "name": run.spec.name,
        "chosen": chosen_row,
        "candidates": _candidates(run, pack, merit, labels),
        "parameters": [_parameter(run, pack, column) for column in run.parameters],
        "metrics": [_column(run, pack, column) for column in run.metric_columns],
        "scores": [_column(run, pack, column) for column in run.score_columns],
        "ends": {pose: _ends(run, pack, pose) for pose in run.poses},
        "map": _map(run, pack),
        "clusters": [
            {"row": int(row), "size": int((labels == label).sum())}
            for label, row in enumerate(leaders)
        ],
        "efficiency": _efficiency(run, pack),
        "shares": _shares(run, pack),
        "hand": {**_hand(run), "sizes": _sizes(hand_dimensions(run), hands)},
        "tool": run.spec.tool.model_dump(mode="json"),
        "poses": [_pose(run, hands, pose) for pose in run.poses],
        "opening": _opening(run, pack, chosen_row),
        "exact": exact_paths(run, paths, shown[len(first) : MAX_EXACT]),
        "thin": thin_paths(run, paths, shown[:MAX_EXACT], merit),
        "meshes": _meshes(run, paths),
        "runs": [_log(log, paths) for log in logs],
    }
    return document, {block.name: block.text() for block in (pack, hands, paths)}


def _chosen_row(run: Run) -> int | None:
    rows = np.flatnonzero(run.ids == run.selected["id"]) if run.selected else []
    return int(rows[0]) if len(rows) else None


def _candidates(run: Run, pack: Packer, merit: Array, labels: NDArray[np.int64]) -> Told:
    return {
        "count": len(run.ids),
        "id": pack.integers(run.ids),
        "parent": pack.integers(run.table["parent"].to_numpy()),
        "measured": pack.integers(np.isin(run.ids, run.metrics["id"].to_numpy())),
        "front": pack.integers(run.front),
        "call": pack.integers(_calls(run)),
        "makeable": pack.integers(flags(run.table, "makeable")),
        "reason": _coded(run, pack, ["reason"]),
        "cluster": pack.integers(labels),
        "mean": pack.exact(merit),
    }


def _opening(run: Run, pack: Packer, chosen: int | None) -> Told | None:
    """What the chosen hand is shown with before the other hands are there."""
    if chosen is None:
        return None
    sizes = hand_dimensions(run, np.array([chosen]))
    return {"row": chosen, "sizes": _sizes(sizes, pack), "exact": exact_paths(run, pack, [chosen])}


def _calls(run: Run) -> NDArray[np.int64]:
    """(n,) number of the call that found each candidate, counted from 1; 0 for the first hand."""
    calls = np.zeros(len(run.ids), dtype=np.int64)
    accepted = run.calls["candidate"].to_numpy()
    found = np.isin(accepted, run.ids)
    calls[np.searchsorted(run.ids, accepted[found])] = np.flatnonzero(found) + 1
    return calls


def _ends(run: Run, pack: Packer, pose: str) -> Told | None:
    """Why the paths end: words, and each candidate's word on both sides."""
    sides = [f"{pose}_end_{side}" for side in ("minus", "plus")]
    if not set(sides) <= set(run.table.column_names):
        return None
    return _coded(run, pack, sides)


def _coded(run: Run, pack: Packer, names: list[str]) -> Told:
    """Columns of words: all words that occur, and for each column each candidate's number."""
    columns = [run.table[name].to_pylist() for name in names if name in run.table.column_names]
    words = sorted({word or "" for column in columns for word in column})
    codes = {word: code for code, word in enumerate(words)}
    coded = [pack.integers([codes[word or ""] for word in column]) for column in columns]
    return {"words": words, "codes": coded}


def _column(run: Run, pack: Packer, column: Column) -> Told:
    return {**asdict(column), "data": pack.exact(numbers(run.table, column.name))}


def _parameter(run: Run, pack: Packer, column: Column) -> Told:
    index = run.space.names.index(column.name)
    bounds = [float(run.space.lower[index]), float(run.space.upper[index])]
    return {**_column(run, pack, column), "bounds": bounds, "free": bounds[0] < bounds[1]}


def _map(run: Run, pack: Packer) -> Told:
    drawn = design_map(run)
    return {"points": pack.exact(drawn.points), "axes": list(drawn.axes), "told": drawn.told}


def _efficiency(run: Run, pack: Packer) -> Told:
    found = efficiency(run)
    curves = {"calls": found.calls, "cumulative": found.cumulative, "recent": found.recent}
    return {"window": found.window, **{name: pack.exact(c) for name, c in curves.items()}}


def _shares(run: Run, pack: Packer) -> Told:
    thresholds, shares = range_shares(run)
    return {
        "thresholds": pack.exact(thresholds),
        "poses": {pose: pack.exact(share) for pose, share in shares.items()},
    }


def _hand(run: Run) -> Told:
    names = TEMPLATES[run.spec.hand.template]
    limits = run.spec.hand.joint_limits_deg
    palm = [
        {
            "name": solid.name,
            "start": _finger_of(solid.start if isinstance(solid, PalmCapsule) else solid.at),
            "end": _finger_of(solid.end if isinstance(solid, PalmCapsule) else solid.at),
            "offset": list(solid.offset_mm),
            "radius": solid.radius_mm,
        }
        for solid in run.spec.hand.palm
    ]
    return {
        "fingers": list(names.fingers),
        "joints": list(names.joints),
        "limits": [[a * RAD_PER_DEG for a in limits[joint]] for joint in names.joints],
        "palm": palm,
    }


def _sizes(sizes: HandDimensions, pack: Packer) -> Told:
    return {
        "radius": pack.exact(sizes.radius_mm),
        "proximal": pack.exact(sizes.proximal_mm),
        "distal": pack.exact(sizes.distal_axis_mm),
        "root_position": pack.exact(sizes.root_position_mm),
        "root_quaternion": pack.exact(sizes.root_quaternion),
    }


def _finger_of(site: str) -> str:
    return site.removesuffix("_root")


def _pose(run: Run, pack: Packer, pose: str) -> Told:
    spec, layout, y = run.spec.poses[pose], layout_of(run.spec, pose), pose_states(run, pose)
    n = len(y)
    designs = run.space.internal(run.designs)
    forces = HoldingForces(run.spec, pose).at(
        designs, y[:, layout.hand], np.zeros(n), y[:, layout.hand.stop :], np.ones(n)
    )
    contacts = y[:, layout.contacts].reshape(n, layout.n_contacts, 4)[:, :, :2]
    return {
        "name": pose,
        "description": spec.description,
        "contacts": [{"finger": c.finger, "link": c.link} for c in spec.contacts],
        "axis": list(spec.turning.axis),
        "pivot": list(spec.turning.pivot_mm),
        "tip_force": spec.tip_force_n,
        "position": pack.quantized(y[:, :3]),
        "rotation": pack.quantized(y[:, 3:6]),
        "joints": pack.quantized(y[:, layout.joints]),
        "axial": pack.quantized(contacts[..., 0]),
        "angle": pack.quantized(contacts[..., 1]),
        "forces": pack.quantized(forces),
    }


def _meshes(run: Run, pack: Packer) -> list[Told]:
    """The chosen hand's meshes; none before it is exported."""
    urdf = run.folder / "hand" / "urdf" / f"{run.spec.name}.urdf"
    exported = run.manifest["stages"].get("export", {})
    if not urdf.exists() or exported.get("status") != "done":
        return []
    return [
        {
            "name": mesh.file,
            "links": list(mesh.links),
            "colour": list(mesh.colour),
            "vertices": pack.quantized(mesh.vertices_mm),
            "faces": pack.integers(mesh.faces),
        }
        for mesh in chosen_meshes(urdf)
    ]


def _log(log: RunLog, pack: Packer) -> Told:
    quantities = [{**asdict(q), "values": pack.exact(q.values)} for q in log.quantities]
    return {"name": log.name, "seconds": pack.exact(log.seconds), "quantities": quantities}
