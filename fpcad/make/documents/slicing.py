"""Slicing the print files with PrusaSlicer, where it is installed."""

from __future__ import annotations

import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from fpcad.errors import StoreError, ToolchainError
from fpcad.make.documents.print_ready import FOLDER
from fpcad.spec.hardware import Print
from fpcad.store import replacing

PROGRAMS = ("prusa-slicer", "PrusaSlicer")
GCODE = "gcode"
TIME = re.compile(r"; estimated printing time \(normal mode\) = (.*)")
FILAMENT = re.compile(r"; filament used \[cm3\] = ([\d.]+)")
HOURS = {"d": 24.0, "h": 1.0, "m": 1 / 60, "s": 1 / 3600}


@dataclass(frozen=True)
class Sliced:
    """What a slicer says of one part."""

    part: str
    hours: float
    filament_g: float
    """Of one piece with its supports."""
    file: Path


def slicer() -> str:
    """The slicer's program; :class:`ToolchainError` says what is missing."""
    for program in PROGRAMS:
        if (found := shutil.which(program)) is not None:
            return found
    raise ToolchainError(
        "slicing needs PrusaSlicer: install it with `apt-get install prusa-slicer`, "
        "or open the files of parts/print in the slicer that you use"
    )


def slice_folder(parts: Path, settings: Print, layer_mm: float) -> Iterator[Sliced]:
    """Slice every print file of a `parts` folder, one after the other."""
    program = slicer()
    files = sorted((parts / FOLDER).glob("*.stl"))
    if not files:
        raise StoreError(f"{parts / FOLDER}: nothing to slice; run `fpcad export` first")
    for file in files:
        is_skin = (parts / "skin" / file.name).is_file()
        density = settings.skin_density_g_cm3 if is_skin else settings.bone_density_g_cm3
        yield slice_file(program, file, parts / GCODE, settings, layer_mm, density)


def slice_file(
    program: str, file: Path, folder: Path, settings: Print, layer_mm: float, density_g_cm3: float
) -> Sliced:
    """Slice one mesh that lies as it is to be printed; supports and a brim where they are needed."""
    width, depth, height = settings.bed_mm
    target = folder / f"{file.stem}.gcode"
    options = [
        *("--layer-height", f"{layer_mm:g}", "--fill-density", "40%", "--perimeters", "3"),
        *("--support-material", "--support-material-auto", "--brim-width", "4"),
        *("--bed-shape", f"0x0,{width:g}x0,{width:g}x{depth:g},0x{depth:g}"),
        *("--max-print-height", f"{height:g}", "--center", f"{width / 2:g},{depth / 2:g}"),
    ]
    with tempfile.TemporaryDirectory() as scratch, replacing(target) as beside:
        gcode = Path(scratch) / target.name
        command = [program, "--export-gcode", *options, "--output", str(gcode), str(file)]
        ran = subprocess.run(command, capture_output=True, text=True, check=False)
        if (
            ran.returncode or not gcode.is_file()
        ):  # its words are no guide: it says error on good parts
            last = (ran.stderr or ran.stdout).strip().splitlines()[-1:]
            raise ToolchainError(
                f"PrusaSlicer failed on {file} ({ran.returncode}): {' '.join(last)}"
            )
        shutil.copyfile(gcode, beside)
        told = gcode.read_text(encoding="utf-8", errors="replace")
    return Sliced(file.stem, hours_of(told), filament_cm3(told) * density_g_cm3, target)


def hours_of(gcode: str) -> float:
    """Print time [h] that the slicer wrote into its file."""
    match = TIME.search(gcode)
    if match is None:
        raise ToolchainError("the slicer told no print time")
    return sum(float(word[:-1]) * HOURS[word[-1]] for word in match.group(1).split())


def filament_cm3(gcode: str) -> float:
    """Volume [cm^3] of filament that the slicer wrote into its file."""
    match = FILAMENT.search(gcode)
    if match is None:
        raise ToolchainError("the slicer told no volume of filament")
    return float(match.group(1))
