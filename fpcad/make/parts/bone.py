"""The rigid bones of a finger: a clevis and a tongue make the IP joint, a fork holds the MCP cross."""

from __future__ import annotations

import math

from fpcad.make.parts.dimensions import Dimensions
from fpcad.make.parts.solids import (
    FAR_MM,
    Solid,
    ball,
    behind_bend,
    box,
    finger_core,
    mirrored_at,
    rod,
)


def distal_bone(d: Dimensions) -> Solid:
    """Core of the fingertip in the distal frame, with the tongue around the IP axis."""
    shaft = finger_core(d.distal_axis_length, d.bone).cut(behind_bend(d.ip_flex, d.clearance))
    room = d.ip_disc + d.clearance
    inner = d.tongue_half_width
    for side in (-1, 1):
        shaft = shaft.cut(rod((0, side * inner, 0), (0, side * FAR_MM, 0), room))
    tongue = rod((0, -inner, 0), (0, inner, 0), d.ip_disc)
    return shaft.fuse(tongue).cut(_ip_pin_hole(d, 0.0)).clean()


def proximal_bone(d: Dimensions) -> Solid:
    """Proximal bone in the proximal frame: fork at the root, neck, shaft, clevis at the IP axis."""
    bend = mirrored_at(behind_bend(d.ip_flex, d.clearance), d.proximal_length)
    shaft = rod((d.shaft_start, 0, 0), (d.proximal_length, 0, 0), d.bone).cut(bend)
    x, slot = d.proximal_length, d.tongue_half_width + d.clearance
    shaft = shaft.cut(rod((x, -slot, 0), (x, slot, 0), d.ip_disc + d.clearance))
    prongs = [
        rod((x, side * slot, 0), (x, side * d.ip_half_width, 0), d.ip_disc) for side in (-1, 1)
    ]
    bone = shaft.fuse(*prongs, _neck(d), _fork(d))
    return bone.cut(_ip_pin_hole(d, x), *_fork_pin_holes(d)).clean()


def _ip_pin_hole(d: Dimensions, x: float) -> Solid:
    return rod((x, -FAR_MM, 0), (x, FAR_MM, 0), d.pin_hole)


def _neck(d: Dimensions) -> Solid:
    """The bar that joins fork and shaft, slim enough to be abducted between the palm's ears."""
    half_height = 0.95 * math.sqrt(d.bone**2 - d.neck_half_width**2)
    half_height = min(half_height, d.fork_outer)
    low = (d.neck_start, -d.neck_half_width, -half_height)
    return box(low, (d.shaft_start + 2.0, d.neck_half_width, half_height))


def _fork(d: Dimensions) -> Solid:
    """Two prongs above and below the MCP cross, joined beyond it; inside the root's sphere."""
    w, inner, outer = d.neck_half_width, d.fork_inner, d.fork_outer
    fork = box((d.neck_start, -w, -outer), (d.root, w, outer))
    for side in (-1, 1):
        low, high = sorted((side * inner, side * outer))
        arm = box((0, -w, low), (d.root, w, high))
        fork = fork.fuse(arm, rod((0, 0, low), (0, 0, high), d.hub))
    return fork.intersect(ball((0, 0, 0), d.root))


def _fork_pin_holes(d: Dimensions) -> list[Solid]:
    return [
        rod((0, 0, side * d.fork_inner / 2), (0, 0, side * d.root), d.pin_hole) for side in (-1, 1)
    ]
