"""Dimensions of many hands at once, from the same template as everything else."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fpcad.look.run import Run
from fpcad.model.hand import hand_template

Array = NDArray[np.float64]


@dataclass(frozen=True)
class HandDimensions:
    """Dimensions of n hands; lengths in mm."""

    radius_mm: Array  # (n,) of all finger links, skin included
    proximal_mm: Array  # (n,) from the finger's root to the IP axis
    distal_axis_mm: Array  # (n,) from the IP axis to the centre of the fingertip
    root_position_mm: Array  # (n, n_fingers, 3) in H
    root_quaternion: Array  # (n, n_fingers, 4) w x y z, in H


def hand_dimensions(run: Run, rows: NDArray[np.int64] | None = None) -> HandDimensions:
    """Dimensions of the candidates in some rows of a run's table; of all of them by default."""
    designs = run.designs if rows is None else run.designs[rows]
    template, names = hand_template(run.spec.hand), run.space.names
    d = ca.SX.sym("d", len(names))
    proximal, distal = (template.link_shape(link, d) for link in ("proximal", "distal"))
    frames = [template.root_frame(finger, d) for finger in template.names.fingers]
    outputs = [
        ca.vertcat(distal.radius, proximal.axis_length, distal.axis_length),
        ca.vertcat(*[frame.p for frame in frames]),
        ca.vertcat(*[ca.vec(frame.R) for frame in frames]),
    ]
    n, fingers = len(designs), len(frames)
    function = ca.Function("dimensions", [d], outputs)
    found = function.map(n)(run.space.internal(designs).T) if n else [np.zeros((3, 0))] * 3
    lengths, positions, rotations = (np.array(value).T for value in found)
    # CasADi stacks a matrix column by column.
    matrices = rotations.reshape(n * fingers, 3, 3).transpose(0, 2, 1) if n else np.zeros((0, 3, 3))
    quaternions = Rotation.from_matrix(matrices).as_quat(scalar_first=True) if n else matrices
    return HandDimensions(
        *lengths.T,
        root_position_mm=positions.reshape(n, fingers, 3),
        root_quaternion=quaternions.reshape(n, fingers, 4),
    )
