"""parts/assembly.md: how a hand goes together, with pictures, tables and an order of steps."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from fpcad.errors import ToolchainError
from fpcad.make.documents.box_views import box_at_a_tensioner, box_pieces, foot_pieces
from fpcad.make.documents.guide_steps import steps
from fpcad.make.documents.stamp import Stamp
from fpcad.make.documents.views import cut_open, draw, finger_pieces, hand_pieces
from fpcad.make.gates.orientation import part_orientation
from fpcad.make.gates.postures import rest_joints
from fpcad.make.loads.strands import PRETENSION_N
from fpcad.make.parts.assembly import Assembly
from fpcad.make.parts.catalogue import Tendon, lookup
from fpcad.make.parts.materials import matters
from fpcad.make.stand.stand import JIG, Stand
from fpcad.make.stand.steps import bench_steps
from fpcad.make.stand.views import stand_pieces
from fpcad.model.geometry import HandGeometry
from fpcad.model.transmission import finger_transmission
from fpcad.spec.schema import Spec
from fpcad.spec.templates import TEMPLATES
from fpcad.units import RAD_PER_DEG

log = logging.getLogger(__name__)

FILE, PICTURES = "assembly.md", "pictures"
TENDON = "DYNEEMA-0.6"
KNOT = "figure-eight stopper at the anchor, double figure-eight loop at the tensioner"
RETENSION = "after 1 h, after 10 h, then every 50 h of use: braid beds in and creeps"
MOTORS = ("m1", "m2", "m3")
LOOPS = {
    "m1": "MCP differential, one side",
    "m2": "MCP differential, other side",
    "m3": "IP joint",
}
STAND_VIEW = (0.9, -1.0, 0.5)
VIEWS = {
    "finger_apart": ("A finger taken apart", (0.3, -1.0, 0.5)),
    "finger_cut": ("A finger cut open at its middle plane", (0.0, -1.0, 1e-4)),
    "foot_cut": ("The flange's foot on the palm, cut open along the palm's bar", (0.0, -1.0, 1e-4)),
    "box_apart": ("The motors' box taken apart", (0.8, -1.0, 0.15)),
    "box_cut": (
        "The motors' box cut open at an extensor: tensioner, strand's way, spool",
        (0.0, -1.0, 1e-4),
    ),
    "hand": ("The whole hand at rest", (0.55, -1.0, 0.3)),
    "hand_behind": ("The same from its other side", (-1.0, 0.7, 0.15)),
}

NEEDED = {"foot_cut": "flange", "box_apart": "motor_box", "box_cut": "tension_carriage"}
"""The part without which a picture shows nothing."""


def write_guide(
    spec: Spec,
    assembly: Assembly,
    geometry: HandGeometry,
    folder: Path,
    stamp: Stamp,
    stand: Stand | None = None,
) -> list[Path]:
    """Write the guide and its pictures; without what drawing needs, the guide says what is missing."""
    files, missing = [], ""
    pieces = {
        "finger_apart": lambda: finger_pieces(assembly, geometry, apart=True),
        "finger_cut": lambda: cut_open(finger_pieces(assembly, geometry, apart=False)),
        "foot_cut": lambda: cut_open(foot_pieces(assembly)),
        "box_apart": lambda: box_pieces(assembly, apart=True),
        "box_cut": lambda: cut_open(box_at_a_tensioner(assembly)),
        "hand": lambda: hand_pieces(assembly, geometry, rest_joints(spec.hand, geometry)),
        "hand_behind": lambda: hand_pieces(assembly, geometry, rest_joints(spec.hand, geometry)),
    }
    try:
        for name in views_of(assembly):
            direction, file = VIEWS[name][1], folder / PICTURES / f"{name}.png"
            files.append(draw(pieces[name](), file, direction, stamp))
        if stand:
            for pose in stand.jigs:
                shown = stand_pieces(stand, assembly, geometry, pose, spec.tool)
                file = folder / PICTURES / f"{JIG}{pose}.png"
                files.append(draw(shown, file, STAND_VIEW, stamp))
    except ToolchainError as error:
        missing = str(error)
        log.warning("assembly.md has no pictures: %s", missing)
    text = guide_text(spec, assembly, stamp, missing, stand)
    return [*files, stamp.write(folder / FILE, text)]


def views_of(assembly: Assembly) -> list[str]:
    """Which pictures there are: those of parts that an assembly lacks are left out."""
    made = {part.name for part in assembly.parts}
    return [name for name in VIEWS if NEEDED.get(name, "palm") in made]


def guide_text(
    spec: Spec, assembly: Assembly, stamp: Stamp, missing: str = "", stand: Stand | None = None
) -> str:
    """The guide in Markdown; `missing` says why there are no pictures."""
    lines = [f"# How to put {spec.name} together", "", stamp.text, ""]
    if missing:
        lines += [f"No pictures were drawn: {missing}", ""]
    else:
        lines += [
            line
            for name in views_of(assembly)
            for title in (VIEWS[name][0],)
            for line in (f"![{title}]({PICTURES}/{name}.png)", "", f"{title}.", "")
        ]
    lines += ["## Print", "", *_print_table(spec, assembly), ""]
    lines += [*_ordered(spec, assembly), "## Buy", "", *_bought_table(assembly), ""]
    lines += ["## Tendons", "", *_tendon_table(spec), ""]
    lines += ["## Steps", "", *steps(spec, assembly, PRETENSION_N), ""]
    if stand and stand.jigs:
        lines += ["## On the bench", "", *bench_steps(stand), ""]
        pictures = () if missing else stand.jigs
        lines += [f"![Hand, jig and tool at {p}]({PICTURES}/{JIG}{p}.png)\n" for p in pictures]
    return "\n".join(lines)


def _print_table(spec: Spec, assembly: Assembly) -> Iterator[str]:
    yield "Each file of `print/` lies as it is to be printed. Print skins in TPE, all else rigid."
    yield ""
    yield "| part | count | material | height mm | needs support mm2 | stands on mm2 |"
    yield "|---|---|---|---|---|---|"
    for part in assembly.parts:
        if part.material == "metal":
            continue
        laid = part_orientation(part, spec.print)
        figures = f"{laid.height_mm:.1f} | {laid.overhang_mm2:.0f} | {laid.base_mm2:.0f}"
        yield f"| {part.name} | {part.count} | {part.material} | {figures} |"


def _ordered(spec: Spec, assembly: Assembly) -> Iterator[str]:
    """What somebody else makes of metal, nothing where all is printed."""
    ordered = [part for part in assembly.parts if part.material == "metal"]
    if not ordered:
        return
    metal = matters(spec.print)["metal"].name
    yield from (
        "## Order",
        "",
        f"Metal prints of {metal}, from `step/`. Ream their holes to the pins.",
        "",
    )
    yield from ("| part | count | file |", "|---|---|---|")
    yield from (f"| {part.name} | {part.count} | step/{part.name}.step |" for part in ordered)
    yield ""


def _bought_table(assembly: Assembly) -> Iterator[str]:
    yield "`bom.csv` has the sources, and power supply, fuse and wiring."
    if assembly.bought:
        yield ""
        yield "| item | count | size | length mm | on |"
        yield "|---|---|---|---|---|"
    for item in assembly.bought:
        length = "" if item.length_mm is None else f"{item.length_mm:g}"
        yield f"| {item.name} | {item.count} | {item.size} | {length} | {item.link} |"


def _tendon_table(spec: Spec) -> Iterator[str]:
    """One row for each motor of a finger: its loop of two strands."""
    row = lookup("tendons", Tendon, TENDON)
    allowed = row.breaking_n * row.knot_share
    yield f"Every motor drives a closed loop of two strands. All are {row.size}, {row.diameter_mm:g} mm braid;"
    yield f"a knot keeps {100 * row.knot_share:.0f} % of its {row.breaking_n:g} N, so {allowed:g} N."
    yield ""
    yield "| loop | moves | motor turns deg | strand travels mm | knots | pretension N | tighten again |"
    yield "|---|---|---|---|---|---|---|"
    for name, (turns, travel) in zip(MOTORS, strand_travel(spec), strict=True):
        yield (
            f"| {name}, every finger | {LOOPS[name]} | {turns:.0f} | {travel:.1f} | {KNOT} | "
            f"{PRETENSION_N:g} | {RETENSION} |"
        )


def strand_travel(spec: Spec) -> list[tuple[float, float]]:
    """Turn [deg] of each motor of a finger over the joints' limits, and its strands' travel [mm]."""
    A = finger_transmission(spec.motors.transmission)
    joints = TEMPLATES[spec.hand.template].joints
    spans = np.array([np.ptp(spec.hand.joint_limits_deg[joint]) for joint in joints])
    turns = np.abs(A) @ spans
    radius = spec.motors.transmission.spool_radius_mm
    return [(float(turn), float(turn * RAD_PER_DEG * radius)) for turn in turns]
