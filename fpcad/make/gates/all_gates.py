"""All gates in their order: what is cheap and says most comes first."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from fpcad.make.gates.bodies import hand_bodies
from fpcad.make.gates.finding import Finding, refuse_errors
from fpcad.make.gates.fixed import check_fixed
from fpcad.make.gates.joints import check_joints
from fpcad.make.gates.meetings import check_meetings, tool_bodies
from fpcad.make.gates.mesh import check_mesh
from fpcad.make.gates.orientation import part_orientation
from fpcad.make.gates.pad import check_pad
from fpcad.make.gates.postures import hand_postures
from fpcad.make.gates.printing import check_bed, check_overhang
from fpcad.make.gates.reach import SOME, check_reach
from fpcad.make.gates.solid import check_solid
from fpcad.make.gates.tubes import check_tubes
from fpcad.make.gates.wall import check_walls
from fpcad.make.parts.assembly import Assembly, Progress
from fpcad.make.parts.part import Part
from fpcad.make.trajectory import Trajectory
from fpcad.model.geometry import HandGeometry
from fpcad.spec.schema import Spec


def check_part(spec: Spec, part: Part) -> list[Finding]:
    """What the gates say of one part: solid, mesh, walls; of a printed one bed and overhang too."""
    least = spec.print.skin_wall_mm if part.material == "skin" else spec.print.bone_wall_mm
    found = check_solid(part.name, part.solid) + check_mesh(part.name, part.mesh)
    if found:  # nothing can be measured on a broken mesh
        return found
    found += check_walls(part.name, part.mesh, least)
    if part.material == "metal":  # whoever makes it decides how it lies
        return found
    laid = part_orientation(part, spec.print)
    found += check_bed(part.name, part.mesh, laid, spec.print)
    return found + check_overhang(part.name, part.mesh, laid)


PARTS = "parts"
"""Title of the gates of parts; where they fail, no others can be run."""

Group = tuple[str, Callable[[], list[Finding]]]
"""What is checked, in a few words, and the check."""


def gate_groups(
    spec: Spec,
    assembly: Assembly,
    geometry: HandGeometry,
    trajectories: Mapping[str, Trajectory],
    every: int = SOME,
) -> Iterator[Group]:
    """The gates one after the other, each only computed when it is called.

    `every` is that of :func:`check_reach`.
    """
    yield PARTS, lambda: [f for part in assembly.parts for f in check_part(spec, part)]
    bodies, hand = hand_bodies(assembly, geometry), spec.hand
    tools = tool_bodies(spec)
    yield "pad", lambda: check_pad(assembly.parts, geometry)
    yield "fixed parts", lambda: check_fixed(bodies, geometry)
    yield "tubes", lambda: check_tubes(spec, geometry)
    yield "joints", lambda: check_joints(bodies, geometry, hand)
    for postures in hand_postures(hand, geometry, trajectories):
        yield postures.name, lambda p=postures: check_meetings(bodies, tools, geometry, p)
    for finger in geometry.fingers:
        yield f"reach of {finger}", lambda f=finger: check_reach(bodies, geometry, hand, f, every)


def pass_gates(
    spec: Spec,
    assembly: Assembly,
    geometry: HandGeometry,
    trajectories: Mapping[str, Trajectory],
    progress: Progress,
) -> list[Finding]:
    """All findings of a hand that may be made.

    Raises :class:`fpcad.errors.MakeError` with the reason at the first group that finds an error.
    """
    found: list[Finding] = []
    for title, check in gate_groups(spec, assembly, geometry, trajectories):
        progress(f"check: {title}")
        own = check()
        refuse_errors(own)
        found += own
    return found
