"""A hand on its stand, with a jig and the tool, as pieces to draw."""

from __future__ import annotations

import numpy as np

from fpcad.make.documents.views import Piece, hand_pieces
from fpcad.make.gates.meetings import tool_mesh
from fpcad.make.parts.assembly import Assembly
from fpcad.make.stand.stand import Stand
from fpcad.model.geometry import HandGeometry
from fpcad.spec.tool import CylinderTool

STAND_COLOURS = ("#9fb4c8", "#7fa08a")
JIG_COLOUR, TOOL_COLOUR = "#5577bb", "#b98b52"


def stand_pieces(
    stand: Stand, assembly: Assembly, geometry: HandGeometry, pose: str, tool: CylinderTool
) -> list[Piece]:
    """All at one pose, in the stand's frame."""
    scene, T = stand.scenes[pose], np.linalg.inv(stand.T_palm_stand)
    hand = hand_pieces(assembly, geometry, scene.joints[0])
    pieces = [(mesh.copy().apply_transform(T), colour) for mesh, colour in hand]
    pieces += [
        (part.mesh, STAND_COLOURS[n % len(STAND_COLOURS)]) for n, part in enumerate(stand.bench)
    ]
    held = tool_mesh(tool, 0.0).apply_transform(scene.T_stand_tool)
    return [*pieces, (stand.jigs[pose].mesh, JIG_COLOUR), (held, TOOL_COLOUR)]
