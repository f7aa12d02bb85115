"""Paths on the page: a few hands' exactly, the front's as quantized keyframes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fpcad.look.holding import HoldingForces
from fpcad.look.layout import layout_of
from fpcad.look.pack import Packer
from fpcad.look.paths import PathStates, stored_paths
from fpcad.look.poses import pose_states
from fpcad.look.run import Run

Array = NDArray[np.float64]
Told = dict[str, Any]

KEYFRAMES = 17
MAX_EXACT = 12
"""Hands with every state on the page, the chosen one among them."""
MAX_THIN = 4000
"""Hands with keyframes on the page; about 1 kB each."""


def exact_paths(run: Run, pack: Packer, rows: Sequence[int]) -> list[Told]:
    """Every stored state of the hands in `rows`, with the forces that hold the tool."""
    ids = {int(run.ids[row]) for row in rows}
    return tell_paths(run, pack, stored_paths(run.folder / "paths.parquet", ids))


def tell_paths(run: Run, pack: Packer, paths: Iterable[PathStates]) -> list[Told]:
    """Every state of some paths, with the forces that hold the tool."""
    forces = {pose: HoldingForces(run.spec, pose) for pose in run.poses}
    hands = {pose: pose_states(run, pose)[:, :6] for pose in run.poses}
    return [_tell(run, pack, path, forces[path.pose], hands[path.pose]) for path in paths]


def _tell(run: Run, pack: Packer, path: PathStates, forces: HoldingForces, hands: Array) -> Told:
    row = int(np.searchsorted(run.ids, path.id))
    design = run.space.internal(run.designs[row])
    pull = np.where(path.tool_angle_rad < 0, -1.0, 1.0)
    x = np.hstack([path.joints_rad, path.contacts])
    contacts = path.contacts.reshape(len(x), -1, 4)
    return {
        "row": row,
        "pose": path.pose,
        "turn": pack.exact(path.tool_angle_rad),
        "position": pack.exact(hands[row, :3]),
        "rotation": pack.exact(hands[row, 3:]),
        "joints": pack.exact(path.joints_rad),
        "axial": pack.exact(contacts[:, :, 0]),
        "angle": pack.exact(contacts[:, :, 1]),
        "forces": pack.exact(forces.at(design, hands[row], path.tool_angle_rad, x, pull)),
    }


def thin_paths(run: Run, pack: Packer, shown: Sequence[int], merit: Array) -> Told:
    """Keyframes of the front's other hands; the best by mean score where they are too many."""
    front = np.setdiff1d(np.flatnonzero(run.front), np.asarray(shown, dtype=int))
    rows = np.sort(front[np.argsort(-merit[front], kind="stable")][:MAX_THIN])
    frames: dict[str, dict[int, PathStates]] = {pose: {} for pose in run.poses}
    for path in stored_paths(run.folder / "paths.parquet", set(run.ids[rows].tolist())):
        frames[path.pose][path.id] = path.keyframes(KEYFRAMES)
    kept = [row for row in rows if all(int(run.ids[row]) in f for f in frames.values())]
    poses = {
        pose: _frames(run, pack, pose, [found[int(run.ids[row])] for row in kept])
        for pose, found in frames.items()
    }
    left_out = len(front) - len(kept)
    told = {"rows": pack.integers(kept), "keyframes": KEYFRAMES, "left_out": left_out}
    return {**told, "poses": poses}


def _frames(run: Run, pack: Packer, pose: str, paths: list[PathStates]) -> Told:
    """Arrays (hands, columns, keyframes): neighbours in time side by side deflate best."""
    layout = layout_of(run.spec, pose)

    def stacked(name: str, width: int) -> Array:
        values = [getattr(path, name).reshape(KEYFRAMES, width).T for path in paths]
        return np.array(values).reshape(len(paths), width, KEYFRAMES)

    contacts = stacked("contacts", 4 * layout.n_contacts)
    return {
        "turn": pack.quantized(stacked("tool_angle_rad", 1), delta=True),
        "joints": pack.quantized(stacked("joints_rad", layout.n_u), delta=True),
        "axial": pack.quantized(contacts[:, 0::4], delta=True),
        "angle": pack.quantized(contacts[:, 1::4], delta=True),
    }
