"""The bill of materials: what is printed and what is bought."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping, Sequence
from dataclasses import astuple, dataclass, fields
from pathlib import Path

from fpcad.make.parts.assembly import Assembly, BoughtItem
from fpcad.make.parts.catalogue import TABLES, Tendon, lookup, table
from fpcad.make.parts.materials import matters
from fpcad.make.parts.mcp_dimensions import TENDON
from fpcad.make.parts.part import Part
from fpcad.make.power import power
from fpcad.spec.catalogue import motor
from fpcad.spec.hardware import Print
from fpcad.spec.schema import Spec
from fpcad.store import write_whole

MOTORS = "motors"


@dataclass(frozen=True)
class BomRow:
    """One line of the bill."""

    item: str
    kind: str
    """`printed`, `made to order` or `bought`."""
    count: int
    size: str
    """Size of a bought item."""
    material: str
    file: str
    """Mesh of a printed part as it lies on the bed, relative to the build's `parts` folder."""
    mass_g: str
    """Mass of one piece [g], where fpcad knows it."""
    volume_cm3: str
    """Volume of one printed piece [cm^3]."""
    hours: str
    """Time to print one piece [h], where it was sliced."""
    source: str
    """Where the sizes of a bought item are from."""
    note: str


def bill_of_materials(
    spec: Spec,
    assembly: Assembly,
    fingers: int,
    hours: Mapping[str, float],
    tendons_mm: Sequence[float] = (),
) -> list[BomRow]:
    """Printed parts first, then what is bought.

    Args:
        hours: print time of one piece by part, of those that were sliced.
        tendons_mm: what is cut of the tendon [mm], one piece each.
    """
    printed = [_made(part, spec.print, hours.get(part.name)) for part in assembly.parts]
    bought = [_item(item) for item in assembly.bought]
    if not any(item.kind == MOTORS for item in assembly.bought):
        row = motor(spec.motors.type)
        bought.append(
            _bought("motor", 3 * fingers, row.type, f"{row.mass_g:g}", row.source, "three a finger")
        )
    if tendons_mm:
        bought.append(_tendon(tendons_mm))
    return [*printed, *bought, *_electrical(spec, 3 * fingers)]


def _made(part: Part, settings: Print, hours: float | None) -> BomRow:
    """A part that is printed, or made to order."""
    matter, ordered = matters(settings)[part.material], part.material == "metal"
    return BomRow(
        item=part.name,
        kind="made to order" if ordered else "printed",
        count=part.count,
        size="",
        material=matter.name,
        file=f"step/{part.name}.step" if ordered else f"print/{part.name}.3mf",
        mass_g=f"{part.mesh.volume * matter.density_g_cm3 * 1e-3:.2f}",
        volume_cm3=f"{part.mesh.volume * 1e-3:.3f}",
        hours="" if hours is None else f"{hours:.2f}",
        source="",
        note="ream the holes to the pins" if ordered else "mass as if printed solid",
    )


def bom_csv(rows: Sequence[BomRow]) -> str:
    """The bill as CSV with a header line."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow([field.name for field in fields(BomRow)])
    writer.writerows(astuple(row) for row in rows)
    return stream.getvalue()


def _item(item: BoughtItem) -> BomRow:
    size = item.size if item.length_mm is None else f"{item.size} x {item.length_mm:g} mm"
    source = ""
    if item.kind in TABLES and item.size in table(item.kind):
        source = getattr(table(item.kind)[item.size], "source", "")
    elif item.kind == MOTORS:
        source = motor(item.size).source
    return _bought(item.name, item.count, size, f"{item.mass_g:.2f}", source, item.kind)


def _tendon(pieces_mm: Sequence[float]) -> BomRow:
    row = lookup("tendons", Tendon, TENDON)
    metres = math.ceil(sum(pieces_mm) / 100.0) / 10.0
    note = f"{len(pieces_mm)} pieces of {min(pieces_mm):.0f} to {max(pieces_mm):.0f} mm, tails included"
    return _bought("tendon", 1, f"{row.size}, {metres:g} m", "", row.source, note)


def _electrical(spec: Spec, motors: int) -> list[BomRow]:
    need = power(spec.motors.type, motors)
    rule = "half of the motors at stall; " + need.source
    return [
        _bought("power_supply", 1, f"{need.supply_v:g} V, {need.supply_a:g} A or more", "", rule, ""),
        _bought("fuse", 1, f"{need.fuse_a:g} A blade fuse with holder", "", "ISO 8820-3", "in the + lead"),
        _bought("supply_lead", 2, f"{need.wire_mm2:g} mm^2 copper, 1 m", "", "", "red and black, XT30 plug"),
        _bought("emergency_switch", 1, f"{need.fuse_a:g} A or more", "", "", "breaks the + lead"),
        _bought("bus_adapter", 1, need.adapter, "", need.source, "USB to the motors' bus"),
        _bought("motor_cable", motors, need.cable, "", need.source, "one a motor"),
    ]  # fmt: skip


def _bought(name: str, count: int, size: str, mass: str, source: str, note: str) -> BomRow:
    return BomRow(name, "bought", count, size, "", "", mass, "", "", source, note)


def write_hours(file: Path, hours: Mapping[str, float]) -> None:
    """Put print times [h] by part into a bill that was written before."""
    rows = list(csv.reader(file.read_text(encoding="utf-8").splitlines()))
    column, item = rows[0].index("hours"), rows[0].index("item")
    for row in rows[1:]:
        if row[item] in hours:
            row[column] = f"{hours[row[item]]:.2f}"
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n").writerows(rows)
    write_whole(file, stream.getvalue())
