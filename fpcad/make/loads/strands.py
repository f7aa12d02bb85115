"""Tension of every tendon of a finger for given motor torques. docs/loads.md, Strands."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

PRETENSION_N = 15.0
"""Holds a strand on its pulley while the other one of its loop is pulled; well below what creeps."""


class Tensions(NamedTuple):
    """Tensions [N] of a finger's strands in K states, none of them negative."""

    flexor: Array  # (K, 3) motors' strands that shorten when their joint flexes
    extensor: Array  # (K, 3) the other strands of the same loops
    palmar: Array  # (K, 2) from input pulleys 1 and 2 to the clamp on the output pulley
    dorsal: Array  # (K,) from pulley to pulley around the free idler
    ip_flexor: Array  # (K,) from drum to IP pulley
    ip_extensor: Array  # (K,)


def tensions(motor_nmm: Array, spool_mm: float, pretension_n: float = PRETENSION_N) -> Tensions:
    """Tensions for motor torques (K, 3) [N mm] of m1, m2, m3; positive torques flex.

    The strands on a pulley have one radius, so the pull that a motor adds reaches the finger's own
    strands as it is.
    """
    pull = np.asarray(motor_nmm, dtype=np.float64) / spool_mm
    flexor, extensor = loop(pull, pretension_n)
    palmar, dorsal = transfer(pull[:, 0], pull[:, 1], pretension_n)
    ip_flexor, ip_extensor = loop(pull[:, 2], pretension_n)
    return Tensions(flexor, extensor, palmar, dorsal, ip_flexor, ip_extensor)


def loop(pull: Array, pretension_n: float) -> tuple[Array, Array]:
    """Tensions of the two strands of a closed loop whose difference is `pull`.

    Alike and both taut, each takes half of the pull; once the slack one hangs, the other takes all.
    """
    return (
        np.maximum(np.maximum(pretension_n + pull / 2, pull), 0.0),
        np.maximum(np.maximum(pretension_n - pull / 2, -pull), 0.0),
    )


def transfer(pull_1: Array, pull_2: Array, pretension_n: float) -> tuple[Array, Array]:
    """Palmar (K, 2) and dorsal (K,) tensions of the differential: T_palmar,i - T_dorsal = pull_i.

    The dorsal strand is as long as both palmar ones, and its idler is free. As the pulleys turn by
    d1, d2 ahead of the output, palmar strands stretch by r d1, r d2 and the dorsal one shortens by
    the sum: it loses a quarter of what both motors pull. Where a strand would push, it hangs.
    """
    dorsal = np.maximum(pretension_n - (pull_1 + pull_2) / 4, 0.0)
    dorsal = np.maximum(dorsal, np.maximum(-pull_1, -pull_2))
    return np.stack([dorsal + pull_1, dorsal + pull_2], axis=1), dorsal


def slack_from_nmm(spool_mm: float, pretension_n: float = PRETENSION_N) -> float:
    """Motor torque [N mm] beyond which one strand of its loop hangs slack and stiffness halves."""
    return 2 * pretension_n * spool_mm
