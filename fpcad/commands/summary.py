"""Results in words and tables, for people."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from fpcad.run.report import RunReport
from fpcad.run.run_trajectory import DryRun
from fpcad.store import read_json, read_table

out = Console()
"""Results go to stdout."""


def print_design(folder: Path, manifest: dict[str, Any], last: str) -> None:
    """What the stages up to `last` did and, once a hand is chosen, what it can."""
    stages = Table(title=f"{manifest['name']} in {folder}", title_justify="left")
    stages.add_column("stage")
    stages.add_column("seconds", justify="right")
    stages.add_column("counts")
    for stage, record in manifest["stages"].items():
        counts = ", ".join(f"{key}: {value}" for key, value in record.get("counts", {}).items())
        stages.add_row(stage, f"{record.get('seconds', 0):.1f}", counts)
    out.print(stages)
    if last in ("select", "export", "report"):
        _print_selected(folder)


def print_run(report: RunReport | DryRun) -> None:
    """How well a trajectory was followed."""
    if isinstance(report, DryRun):
        out.print(
            f"within limits: {report.knots} knots over {report.seconds:.1f} s, "
            f"{math.degrees(report.wire_error_rad):.2g} deg lost on the wire"
        )
        return
    table = Table(title=f"{report.controller}: {report.final_state}", title_justify="left")
    table.add_column("joint")
    table.add_column("largest error [deg]", justify="right")
    table.add_column("rms error [deg]", justify="right")
    joints = zip(report.joint_names, report.max_error_rad, report.rms_error_rad, strict=True)
    for name, largest, rms in joints:
        table.add_row(name, f"{math.degrees(largest):.3f}", f"{math.degrees(rms):.3f}")
    all_joints = report.max_error_all_rad, report.rms_error_all_rad
    table.add_section()
    table.add_row("all", *(f"{math.degrees(error):.3f}" for error in all_joints))
    out.print(table)
    out.print(
        f"{report.knots} knots in {report.seconds:.1f} s, {report.resends} resends, "
        f"{report.bad_frames} bad frames"
    )


def _print_selected(folder: Path) -> None:
    selected = read_json(folder / "selected.json")
    metrics = read_table(folder / "metrics.parquet").to_pylist()
    row = next(row for row in metrics if row["id"] == selected["id"])
    design = ", ".join(f"{name} {value:.1f}" for name, value in selected["design"].items())
    out.print(f"hand {selected['id']}: {selected['reason']}\n{design}")
    table = Table(title="what it does and what that takes", title_justify="left")
    for heading in (
        "pose",
        "turns\n\\[deg]",
        "slides\n\\[mm/s]",
        "torque p90\n\\[N m]",
        "joint torques\nfor tip force\n\\[N m]",
        "tip force\nasked, held\n\\[N]",
    ):
        table.add_column(heading, justify="left" if heading == "pose" else "right", no_wrap=True)
    for pose, torque in selected["torque"].items():
        table.add_row(
            pose,
            f"{row[f'{pose}_tmr_deg']:.1f}",
            _number(row[f"{pose}_mss_mm_s"]),
            f"{row[f'{pose}_mft_p90_nmm'] / 1000:.2f}",
            ", ".join(f"{value:.2f}" for value in torque["joint_torque_nm"].values()),
            f"{torque['tip_force_n']:g}, {torque['held_tip_force_n']:.1f}",
        )
    out.print(table)
    torque = next(iter(selected["torque"].values()))
    given = ", ".join(f"{j} {t:.2f}" for j, t in torque["motor_joint_torque_nm"].items())
    out.print(f"{selected['motor']} motors give each joint alone, continuously: {given} N m")


def _number(value: float | None) -> str:
    return "no path" if value is None or math.isnan(value) else f"{value:.2f}"
