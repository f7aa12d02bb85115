"""Candidates, calls and paths as tables, and back; every number keeps all its digits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from fpcad.model.pose import StateLayout
from fpcad.model.state import state_columns
from fpcad.sample.rrt import ACCEPTED, Call, Proposal
from fpcad.sample.space import DesignSpace
from fpcad.sample.tree import Candidate
from fpcad.solve.attempt import SolvedPose, Workbench
from fpcad.solve.measure import Residual
from fpcad.wield.path import WieldingPath

Array = NDArray[np.float64]

REJECTED = "rejected"
MEASURES = ("cost", *(f"residual_{field}" for field in Residual._fields))


def call_schema(space: DesignSpace) -> pa.Schema:
    """Columns of calls.parquet."""
    integers = [(name, pa.int64()) for name in ("number", "parent", "candidate")]
    words = [(name, pa.string()) for name in ("outcome", "reason")]
    designs = [(name, pa.float64()) for name in space.names]
    return pa.schema([*integers, *words, *designs])


def candidate_schema(bench: Workbench, space: DesignSpace) -> pa.Schema:
    """Columns of candidates.parquet."""
    columns = list(space.names)
    for pose, kernels in bench.kernels.items():
        columns += state_columns(pose, bench.template.names, kernels.layout)
        columns += [f"{pose}.{measure}" for measure in MEASURES]
    numbers = [(name, pa.float64()) for name in columns]
    counts = [(f"{pose}.iterations", pa.int64()) for pose in bench.kernels]
    return pa.schema([("id", pa.int64()), ("parent", pa.int64()), *numbers, *counts])


def call_row(call: Call, space: DesignSpace) -> dict[str, Any]:
    """One RRT call as a row."""
    numbers = {"number": call.proposal.call, "parent": call.proposal.parent}
    accepted = call.outcome == ACCEPTED
    return {
        **numbers,
        "candidate": call.candidate,
        "outcome": ACCEPTED if accepted else REJECTED,
        "reason": "" if accepted else call.outcome,
        **dict(zip(space.names, call.proposal.named.tolist(), strict=True)),
    }


def read_call(row: dict[str, Any], space: DesignSpace) -> Call:
    """Inverse of :func:`call_row`."""
    named = np.array([row[name] for name in space.names])
    return Call(
        Proposal(row["number"], row["parent"], named), row["reason"] or ACCEPTED, row["candidate"]
    )


def candidate_row(candidate: Candidate, bench: Workbench, space: DesignSpace) -> dict[str, Any]:
    """One candidate as a row: design, states, cost and residual of each pose."""
    row: dict[str, Any] = {"id": candidate.id, "parent": candidate.parent}
    row |= dict(zip(space.names, candidate.named.tolist(), strict=True))
    for pose, solved in candidate.poses.items():
        columns = state_columns(pose, bench.template.names, bench.kernels[pose].layout)
        row |= dict(zip(columns, solved.y.tolist(), strict=True))
        measures = (solved.cost, *solved.residual)
        row |= {f"{pose}.{name}": value for name, value in zip(MEASURES, measures, strict=True)}
        row[f"{pose}.iterations"] = solved.iterations
    return row


def read_candidate(row: dict[str, Any], bench: Workbench, space: DesignSpace) -> Candidate:
    """Inverse of :func:`candidate_row`."""
    poses = {}
    for pose, kernels in bench.kernels.items():
        columns = state_columns(pose, bench.template.names, kernels.layout)
        cost, *residual = (row[f"{pose}.{name}"] for name in MEASURES)
        y = np.array([row[name] for name in columns])
        poses[pose] = SolvedPose(y, cost, Residual(*residual), row[f"{pose}.iterations"])
    named = np.array([row[name] for name in space.names])
    return Candidate(row["id"], row["parent"], named, poses)


def path_table(candidate: int, path: WieldingPath) -> pa.Table:
    """The N states of a candidate's path as rows."""
    n = len(path.tool_angle_rad)

    def each(value: object, type: pa.DataType) -> pa.Array:
        return pa.array([value] * n, type)

    columns = {
        "id": each(candidate, pa.int64()),
        "pose": each(path.pose, pa.string()),
        "state": pa.array(np.arange(n), pa.int64()),
        "tool_angle_rad": pa.array(path.tool_angle_rad),
        "joints_rad": _lists(path.joints_rad),
        "contacts_mm_rad": _lists(path.contacts),
        "hand_in_tool_mm_rad": each(path.hand_in_tool.tolist(), pa.list_(pa.float64())),
        "torque_nmm": pa.array(path.torque_nmm),
        "tip_force_n": pa.array(path.tip_force_n),
        "end_minus": each(path.end_minus, pa.string()),
        "end_plus": each(path.end_plus, pa.string()),
    }
    return pa.table(columns, schema=PATH_SCHEMA)


def read_path(table: pa.Table, layout: StateLayout) -> WieldingPath:
    """The path whose states, one pose of one candidate, are the rows of a table."""
    table = table.sort_by("state")
    n, first = table.num_rows, table.slice(0, 1).to_pylist()[0]

    def numbers(column: str) -> Array:
        return np.array(table[column].to_pylist())

    return WieldingPath(
        pose=first["pose"],
        tool_angle_rad=numbers("tool_angle_rad"),
        joints_rad=numbers("joints_rad").reshape(n, layout.n_fingers, layout.n_joints),
        contacts=numbers("contacts_mm_rad").reshape(n, layout.n_contacts, -1),
        torque_nmm=numbers("torque_nmm"),
        tip_force_n=numbers("tip_force_n"),
        hand_in_tool=np.array(first["hand_in_tool_mm_rad"]),
        end_minus=first["end_minus"],
        end_plus=first["end_plus"],
    )


def _lists(values: Array) -> pa.Array:
    """One list of all numbers for each of the first axis's entries."""
    flat = values.reshape(len(values), -1)
    offsets = np.arange(len(flat) + 1, dtype=np.int32) * flat.shape[1]
    return pa.ListArray.from_arrays(pa.array(offsets), pa.array(flat.ravel()))


PATH_SCHEMA = pa.schema(
    [
        ("id", pa.int64()),
        ("pose", pa.string()),
        ("state", pa.int64()),
        ("tool_angle_rad", pa.float64()),
        ("joints_rad", pa.list_(pa.float64())),
        ("contacts_mm_rad", pa.list_(pa.float64())),
        ("hand_in_tool_mm_rad", pa.list_(pa.float64())),
        ("torque_nmm", pa.float64()),
        ("tip_force_n", pa.float64()),
        ("end_minus", pa.string()),
        ("end_plus", pa.string()),
    ]
)
