"""Gate: no two parts of different fingers, of palm and tool meet at rest or along a trajectory.

Pairs of one finger, and of a finger with its own joint at the palm, are judged over the whole range of their joints in
`joints.py`; what is free there is free here.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

import numpy as np
import trimesh
from numpy.typing import NDArray

from fpcad.make.gates.approach import closest_approach
from fpcad.make.gates.bodies import TOOL, Body, body_of, body_poses
from fpcad.make.gates.bounds import box_gap, swept_box
from fpcad.make.gates.finding import Finding, Severity, point
from fpcad.make.gates.meeting import Overlap
from fpcad.make.gates.postures import Postures
from fpcad.model.geometry import HandGeometry
from fpcad.spec.schema import Spec
from fpcad.spec.tool import CylinderTool

Array = NDArray[np.float64]

GATE = "interference"
TOLD_MM = 2.0
"""Clearances are measured up to this."""
CONTACT_MM = 0.05
"""What touches the tool may dip into it by this: the meshes' and the contact's tolerance."""
TOOL_FACETS = 96
TOOL_RING_MM = 4.0


def tool_bodies(spec: Spec) -> dict[bool, Body]:
    """The tool as it is, and as it is to the links that touch it (True): slimmer by what they may dip."""
    dip = CONTACT_MM + spec.print.skin_oversize_mm
    return {
        False: body_of(TOOL, TOOL, tool_mesh(spec.tool, 0.0)),
        True: body_of(TOOL, TOOL, tool_mesh(spec.tool, dip)),
    }


def tool_mesh(tool: CylinderTool, less_mm: float) -> trimesh.Trimesh:
    """The tool in its frame [mm], its surface moved inwards by `less_mm`.

    It is cut into rings: the boxes around long facets that lie askew would each hold half the hand.
    """
    back, tip, radius = tool.back_mm + less_mm, tool.tip_mm - less_mm, tool.radius_mm - less_mm
    along = np.linspace(back, tip, 2 + int((tip - back) / TOOL_RING_MM))
    outline = [(0.0, back), *((radius, x) for x in along), (0.0, tip)]
    mesh = trimesh.creation.revolve(np.array(outline), sections=TOOL_FACETS)
    z_to_x = trimesh.transformations.rotation_matrix(np.pi / 2, [0, 1, 0])
    return mesh.apply_transform(z_to_x)


def check_meetings(
    bodies: Sequence[Body], tools: dict[bool, Body], geometry: HandGeometry, postures: Postures
) -> list[Finding]:
    """Overlaps over a set of postures, and the least clearance where there is none."""
    poses = {id(body): body_poses(body, geometry, postures.joints) for body in bodies}
    present = list(bodies)
    if postures.tool is not None:
        present += tools.values()
        poses |= {id(tool): postures.tool for tool in tools.values()}
    boxes = {id(body): swept_box(body, poses[id(body)]) for body in present}
    found: list[Finding] = []
    least, closest = TOLD_MM, "none closer"
    for a, b in _pairs(bodies, tools, postures):
        if box_gap(boxes[id(a)], boxes[id(b)]) > least:
            continue
        approach = closest_approach(a, poses[id(a)], b, poses[id(b)], least)
        if approach.overlap is not None:
            found.append(
                _meeting(postures, f"{a.name} and {b.name}", approach.overlap, approach.posture)
            )
        elif approach.gap_mm < least and not _touches(a, b, postures):
            least, closest = approach.gap_mm, f"{a.name} and {b.name}"
    if not found:
        text = f"{'more than ' if least == TOLD_MM else ''}{least:.2f} mm between {closest}"
        told = "hand" if least == TOLD_MM else closest
        found.append(
            Finding(GATE, Severity.FIGURE, told, least, 0.0, "mm", f"{postures.name}: {text}")
        )
    return found


def _pairs(
    bodies: Sequence[Body], tools: dict[bool, Body], postures: Postures
) -> Iterator[tuple[Body, Body]]:
    ordered = sorted(bodies, key=lambda body: body.finger is not None)  # the palm comes first
    for a, b in combinations(ordered, 2):
        if (a.finger != b.finger and b.link != "mcp") or (
            a.finger != b.finger and a.finger is not None
        ):
            yield a, b
    if postures.tool is not None:
        for a in ordered:
            yield a, tools[(a.finger, a.link) in postures.touching]


def _touches(a: Body, b: Body, postures: Postures) -> bool:
    return b.link == TOOL and (a.finger, a.link) in postures.touching


def _meeting(postures: Postures, pair: str, overlap: Overlap, number: int) -> Finding:
    degrees = ""
    if len(postures.joints) > 1:
        degrees = f", posture {number + 1} of {len(postures.joints)}"
    advice = "; hand.rest_posture_deg decides" if postures.tool is None else ""
    volume = overlap.volume_mm3
    text = f"they share {volume:.3g} mm^3 {postures.name}{degrees}{advice}"
    return Finding(GATE, Severity.ERROR, pair, volume, 0.0, "mm^3", text, point(overlap.at_mm))
