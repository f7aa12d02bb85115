"""All gates and loads again, on the files of a finished hand."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from fpcad.errors import StoreError
from fpcad.make.documents.inventory import FILE, read_inventory
from fpcad.make.documents.stand_file import FILE as STAND
from fpcad.make.documents.stand_file import read_stand
from fpcad.make.gates.all_gates import PARTS, gate_groups
from fpcad.make.gates.finding import Finding, errors
from fpcad.make.gates.reach import SOME
from fpcad.make.loads.check import TITLE, load_findings
from fpcad.make.loads.hand import hand_loads
from fpcad.make.stand.stand import check_stand
from fpcad.make.trajectory_file import read_trajectory
from fpcad.model.geometry import HandGeometry
from fpcad.spec.schema import Spec


def recheck(
    spec: Spec, geometry: HandGeometry, build: Path, every: int = SOME
) -> Iterator[tuple[str, list[Finding]]]:
    """What each group of gates finds in a build's files, one after the other, with its title.

    Args:
        every: how finely the reach of the fingers is walked; see :func:`fpcad.make.gates.reach.check_reach`.
    """
    parts = build / "parts"
    if not (parts / FILE).is_file():
        raise StoreError(f"{build}: no parts here; run `fpcad export {spec.name}` first")
    assembly = read_inventory(parts)
    files = sorted((build / "trajectories").glob("*.json"))
    trajectories = {file.stem: read_trajectory(file) for file in files}
    for title, check in gate_groups(spec, assembly, geometry, trajectories, every):
        found = check()
        yield title, found
        if title == PARTS and errors(found):  # broken meshes have no distances to measure
            return
    if (parts / STAND).is_file():
        stand = read_stand(spec, geometry, trajectories, parts)
        yield "bench stand", check_stand(spec, geometry, assembly, stand)
    yield TITLE, load_findings(hand_loads(spec, assembly, geometry, trajectories))
