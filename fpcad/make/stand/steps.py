"""What is bought for the stand, and how it is used."""

from __future__ import annotations

from fpcad.make.bom import BomRow
from fpcad.make.parts.catalogue import Flange, Screw, lookup
from fpcad.make.stand.bench import WALL_MM
from fpcad.make.stand.stand import BENCH, FRONT, JIG, Stand
from fpcad.spec.schema import Spec


def stand_rows(spec: Spec) -> list[BomRow]:
    """What is bought for the stand."""
    flange = lookup("flanges", Flange, spec.mount.flange)
    screw = lookup("screws", Screw, flange.screw)
    size = f"{screw.size} x {flange.disc_mm + WALL_MM + 10:g} mm or more (nuts where the base has none)"
    row = BomRow(
        "stand_screw",
        "bought",
        flange.screws,
        size,
        "",
        "",
        "",
        "",
        "",
        screw.source,
        "hand to stand",
    )
    band = BomRow("rubber_band", "bought", 2, "60 mm", "", "", "", "", "", "", "tool to jig")
    return [row, band]


def bench_steps(stand: Stand) -> list[str]:
    """How the stand is used, in Markdown."""
    if not stand.parts:
        return []
    joined = f" Lower `{FRONT}` onto the tongue of `{BENCH}`." if len(stand.bench) > 1 else ""
    lines = [
        f"1. Bolt the hand by its base to `{BENCH}`, the palm forward.{joined}",
        "2. `fpcad run-trajectory ... --to-start --wait-for-tool` leads the hand to the pose and waits, its grip open.",
    ]
    jigs = ", ".join(f"`{JIG}{pose}`" for pose in stand.jigs)
    lines += [
        f"3. Slide the pose's jig ({jigs}) into its channel up to the end: each fits its own and no narrower one.",
        "4. Lay the tool into both notches, its end against the stop; a rubber band around tool and spine holds it.",
        "5. Press Enter: the grip closes. Take the band off and draw the jig straight back out of its channel.",
    ]
    return lines
