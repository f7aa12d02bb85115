"""What pictures of flange and motors' box show: the foot, the box taken apart, a tensioner."""

from __future__ import annotations

import numpy as np

from fpcad.make.documents.views import Piece, piece_colour
from fpcad.make.parts.assembly import Assembly
from fpcad.make.parts.part import STILL_LINKS, Array

FOOT = ("palm", "flange", "flange_foot_insert", "flange_foot_screw")
APART_MM = {
    "motor_box": (0.0, 0.0),
    "flange_nut": (35.0, 0.0),
    "tension_carriage": (-40.0, 0.0),
    "tension_insert": (-40.0, 0.0),
    "tension_screw": (-70.0, 0.0),
    "motor": (90.0, 0.0),
    "spool": (90.0, 35.0),
    "horn_screw": (90.0, -60.0),
    "spool_screw": (90.0, -85.0),
    "back_insert": (15.0, 0.0),
    "box_back": (190.0, 0.0),
    "back_screw": (220.0, 0.0),
    "robot_screw": (165.0, 0.0),
}
"""How far each piece of the box is drawn along z of H, and then along its own z."""


def foot_pieces(assembly: Assembly) -> list[Piece]:
    """Palm and flange with what joins them, in H."""
    return [
        (item.mesh.copy().apply_transform(place), piece_colour(item))
        for item in (*assembly.parts, *assembly.bought)
        if item.name in FOOT
        for place in item.places
    ]


def box_pieces(assembly: Assembly, apart: bool) -> list[Piece]:
    """The motors' box in H, put together or taken apart."""
    pieces = []
    for item in (*assembly.parts, *assembly.bought):
        if item.link in STILL_LINKS and item.name in APART_MM:
            for place in item.places:
                pose = _shifted(place, *APART_MM[item.name]) if apart else place
                pieces.append((item.mesh.copy().apply_transform(pose), piece_colour(item)))
    return pieces


def box_at_a_tensioner(assembly: Assembly) -> list[Piece]:
    """The box in a frame in which the plane y = 0 holds one extensor's strand and its tension screw."""
    carriage = next(part for part in assembly.parts if part.name == "tension_carriage")
    x_to_y = np.eye(4)
    x_to_y[:2, :2] = [[0.0, -1.0], [1.0, 0.0]]
    T = x_to_y @ np.linalg.inv(carriage.places[0])
    return [(mesh.apply_transform(T), colour) for mesh, colour in box_pieces(assembly, apart=False)]


def _shifted(place: Array, dorsal: float, own: float) -> Array:
    pose = place.copy()
    pose[:3, 3] += own * place[:3, 2]
    pose[2, 3] += dorsal
    return pose
