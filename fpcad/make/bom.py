"""The bill of materials: what is printed and what is bought."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import astuple, dataclass, fields

from fpcad.make.parts.dimensions import PIN_RADIUS_MM, Dimensions
from fpcad.make.parts.mcp import PIN_BOTTOM_MM
from fpcad.make.parts.part import Part
from fpcad.spec.schema import Spec


@dataclass(frozen=True)
class BomRow:
    """One line of the bill."""

    item: str
    kind: str
    """`printed` or `bought`."""
    count: int
    material: str
    file: str
    """Mesh of a printed part, relative to the build's `parts` folder."""
    mass_g: str
    """Mass of one piece [g], where fpcad knows it."""
    note: str


def bill_of_materials(
    spec: Spec, d: Dimensions, parts: Sequence[Part], fingers: int, motor_mass_g: float
) -> list[BomRow]:
    """Printed parts first, then what is bought."""
    density = {
        "endoskeleton": spec.print.bone_density_g_cm3,
        "skin": spec.print.skin_density_g_cm3,
    }
    material = {"endoskeleton": "rigid (PLA or the like)", "skin": "flexible (TPE)"}
    printed = [
        BomRow(
            part.name,
            "printed",
            part.count,
            material[part.material],
            f"{part.material}/{part.name}.stl",
            f"{part.mesh.volume * density[part.material] * 1e-3:.2f}",
            "",
        )
        for part in parts
    ]
    motor = BomRow(
        spec.motors.type, "bought", 3 * fingers, "", "", f"{motor_mass_g:g}", "three a finger"
    )
    return [*printed, *_pins(d, fingers), motor]


def _pins(d: Dimensions, fingers: int) -> list[BomRow]:
    diameter = 2 * PIN_RADIUS_MM
    lengths = (
        ("mcp_flexion_pin", fingers, 2 * (d.root - d.clearance), "through ears and MCP cross"),
        (
            "mcp_abduction_pin",
            2 * fingers,
            d.fork_outer - d.pin_hole - PIN_BOTTOM_MM,
            "fork to cross",
        ),
        ("ip_pin", fingers, 2 * d.ip_half_width, "through clevis and tongue"),
    )
    return [
        BomRow(
            name,
            "bought",
            count,
            "steel",
            "",
            "",
            f"dowel pin {diameter:g} mm, {length:.1f} mm long: {where}",
        )
        for name, count, length, where in lengths
    ]


def bom_csv(rows: Sequence[BomRow]) -> str:
    """The bill as CSV with a header line."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow([field.name for field in fields(BomRow)])
    writer.writerows(astuple(row) for row in rows)
    return stream.getvalue()
