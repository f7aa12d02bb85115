"""Gates: a part fits the print bed, and how much of it needs support."""

from __future__ import annotations

import numpy as np
import trimesh

from fpcad.make.gates.finding import Finding, Severity, point
from fpcad.make.gates.orientation import Orientation
from fpcad.spec.hardware import Print

BED, OVERHANG = "bed", "overhang"


def check_bed(
    part: str, mesh: trimesh.Trimesh, orientation: Orientation, settings: Print
) -> list[Finding]:
    """Whether a part [mm], laid as proposed, fits the printer; it may be turned by a right angle."""
    laid = mesh.vertices @ orientation.T_bed_part[:3, :3].T
    size = laid.max(axis=0) - laid.min(axis=0)
    allowed = np.array(settings.bed_mm)
    excess = min(float(np.max(np.array([*flat, size[2]]) - allowed)) for flat in _turns(size))
    text = "{:.1f} x {:.1f} x {:.1f} mm".format(*size)
    if excess > 0:
        text += " does not fit the bed of {:g} x {:g} x {:g} mm".format(*allowed)
    severity = Severity.ERROR if excess > 0 else Severity.FIGURE
    where = point(mesh.bounds.mean(axis=0))
    return [Finding(BED, severity, part, float(size.max()), allowed.max(), "mm", text, where)]


def check_overhang(part: str, mesh: trimesh.Trimesh, orientation: Orientation) -> list[Finding]:
    """The area that needs support in the proposed orientation; told, and no reason to refuse."""
    area = orientation.overhang_mm2
    share = area / mesh.area
    text = f"{area:.0f} mm^2 ({100 * share:.0f} %) need support, standing on {orientation.base_mm2:.0f} mm^2"
    severity = Severity.WARNING if area > 0 else Severity.FIGURE
    where = point(orientation.overhang_at_mm) if area > 0 else None
    return [Finding(OVERHANG, severity, part, area, 0.0, "mm^2", text, where)]


def _turns(size: np.ndarray) -> tuple[tuple[float, float], ...]:
    return (float(size[0]), float(size[1])), (float(size[1]), float(size[0]))
