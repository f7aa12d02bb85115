"""How long each tendon is at any posture of the modelled parts, measured along its way in space.

The strands inside a finger do not stretch: from their lengths follow the angles of pulleys and drum,
and from those how far each motor's strand is pulled. No transmission matrix enters, so the lengths
are a check of it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import root_scalar

from fpcad.make.parts.bone import ip_tangents
from fpcad.make.parts.dimensions import ANCHOR_MARGIN_RAD, Dimensions
from fpcad.make.parts.routing import Strand, strands

Array = NDArray[np.float64]

TRANSFER_ANCHOR_RAD = 1.5 * math.pi
"""Angle of the transfer strands' knot on an input pulley, in the frame that flexion carries."""
CLAMP_RAD = 0.0
"""Angle of the transfer strands' clamp on an output disc, from the finger's axis."""
IP_ANCHOR_RAD = math.radians(40.0)
"""Angle of both IP strands' knot on the IP pulley, in the distal frame."""
ARC_STEP_RAD = 1e-3
MOST_TURN_RAD = 2 * math.pi


@dataclass(frozen=True)
class FingerTendons:
    """The strands of one finger [mm, rad]; angles about the flexion axis as in `routing`."""

    d: Dimensions
    T_palm_root: Array

    def motor_strands(self, joints: Array) -> dict[str, float]:
        """Length [mm] of each motor's strand from its knot to where it leaves the palm.

        `joints` (3,) are flexion, abduction and IP angle [rad].
        """
        turns = self.pulley_turns(joints)
        found = {}
        for strand in strands(self.d, self.T_palm_root):
            motor = strand.name.split("_")[0]
            found[strand.name] = self._to_exit(strand, turns[motor])
        return found

    def pulley_turns(self, joints: Array) -> dict[str, float]:
        """Turn [rad] of both input pulleys and the drum that keeps the finger's own strands taut."""
        zero = np.zeros(3)
        return {
            "m1": self._turn(lambda turn, q: self._transfer(turn, q, 1), joints, zero),
            "m2": self._turn(lambda turn, q: self._transfer(turn, q, -1), joints, zero),
            "m3": self._turn(self._ip_extensor, joints, zero),
        }

    def own_strands(self) -> tuple[float, float]:
        """Lengths [mm] of the strand from input pulley to input pulley, and of one to the IP pulley."""
        zero = np.zeros(3)
        across = sum(self._transfer(0.0, zero, hand) for hand in (1, -1))
        return across, self._ip_extensor(0.0, zero)

    def _turn(self, length: Callable[[float, Array], float], joints: Array, zero: Array) -> float:
        at_rest = length(0.0, zero)
        found = root_scalar(
            lambda turn: length(turn, joints) - at_rest,
            bracket=(-MOST_TURN_RAD, MOST_TURN_RAD),
            xtol=1e-12,
        )
        return float(found.root)

    def _to_exit(self, strand: Strand, turn: float) -> float:
        """From the knot around the pulley and out; the knot lies so that some wrap always remains."""
        low, high = self._turns(strand.name.split("_")[0])
        last = high if strand.sense > 0 else -low
        wrap = last + ANCHOR_MARGIN_RAD - strand.sense * turn
        return _polyline(strand.outside()) + strand.radius * wrap

    def _turns(self, motor: str) -> tuple[float, float]:
        """Least and greatest turn [rad] of a pulley, for where its knots are put."""
        d = self.d
        if motor == "m3":
            other, ratio = d.ip_flex, d.ip_pulley / d.mcp.drum_radius
        else:
            widest = d.widest_abduction
            other, ratio = (-widest, widest), d.mcp.output_radius / d.mcp.input_radius
        return d.mcp_flex[0] + ratio * other[0], d.mcp_flex[1] + ratio * other[1]

    def _transfer(self, turn: float, joints: Array, hand: int) -> float:
        """Palmar strand of one input pulley: knot, pitch point, clamp. Points in the root's frame."""
        m = self.d.mcp
        start, end = math.pi + joints[0], TRANSFER_ANCHOR_RAD + turn
        on_pulley = _arc(start, end, m.input_radius)
        pulley = np.stack(
            [on_pulley[:, 0], np.full(len(on_pulley), hand * m.output_radius), on_pulley[:, 1]],
            axis=1,
        )
        clamp = CLAMP_RAD + hand * joints[1]
        on_disc = _arc(0.0, math.pi / 2 - clamp, m.output_radius)
        disc = np.stack(
            [on_disc[:, 0], hand * on_disc[:, 1], np.full(len(on_disc), -m.input_radius)], axis=1
        )
        sign = 1.0 if end >= start else -1.0
        return sign * _polyline(pulley) + _polyline(disc @ _rot_y(joints[0]).T)

    def _ip_extensor(self, turn: float, joints: Array) -> float:
        """Dorsal IP strand: knot on the drum, its tangent, the IP pulley's tangent, knot there."""
        (x0, z0), (x1, z1) = ip_tangents(self.d, 1)
        leaving = math.atan2(x0, z0)
        on_drum = 2 * math.pi + leaving + joints[0] - (TRANSFER_ANCHOR_RAD - math.pi / 4 + turn)
        abducted = _rot_z(joints[1]) @ np.array([x1, 0.0, z1])
        straight = float(np.linalg.norm(abducted - np.array([x0, 0.0, z0])))
        arriving = math.atan2(x1 - self.d.proximal_length, z1)
        on_pulley = IP_ANCHOR_RAD + joints[2] - arriving
        return self.d.mcp.drum_radius * on_drum + straight + self.d.ip_pulley * on_pulley


def motor_turns(d: Dimensions, T_palm_root: Array, spool: float, joints: Array) -> Array:
    """Motor angles (3,) [rad] at joints (3,) [rad], by how far the flexor strands have been pulled."""
    tendons = FingerTendons(d, T_palm_root)
    rest, now = tendons.motor_strands(np.zeros(3)), tendons.motor_strands(joints)
    names = [f"{motor}_flexor" for motor in ("m1", "m2", "m3")]
    return np.array([(rest[name] - now[name]) / spool for name in names])


def _arc(start: float, end: float, radius: float) -> Array:
    """(n, 2) points (sin, cos) on a circle between two angles."""
    angles = np.linspace(start, end, max(2, math.ceil(abs(end - start) / ARC_STEP_RAD)))
    return radius * np.stack([np.sin(angles), np.cos(angles)], axis=1)


def _polyline(points: Array) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def _rot_y(angle: float) -> Array:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def _rot_z(angle: float) -> Array:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
