"""From a trajectory that touches the tool to one that grips it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fpcad.errors import MakeError
from fpcad.make.grip import Grip
from fpcad.make.preload.margins import Margins
from fpcad.make.preload.plan import grip_preload
from fpcad.make.trajectory import Trajectory
from fpcad.model.geometry import HandGeometry
from fpcad.spec.schema import Spec

Array = NDArray[np.float64]


def tightened(
    trajectory: Trajectory, spec: Spec, pose: str, geometry: HandGeometry, hand_in_tool: Array
) -> tuple[Trajectory, Margins]:
    """The trajectory with its grip preload, and how far that grip is from slipping.

    Args:
        trajectory: knots in contact.
        spec: the pose's turning, and the grip.
        pose: which of the spec's poses the trajectory belongs to.
        geometry: the hand.
        hand_in_tool: (6,) xyz [mm], roll pitch yaw [rad] of H in O.

    Raises:
        MakeError: no forces hold the tool within the motors' torque.
    """
    turning = spec.poses[pose].turning
    grip = Grip(geometry, spec.tool, turning, hand_in_tool, trajectory.contacts)
    try:
        preload = grip_preload(spec, grip, trajectory.position_rad, trajectory.tool.angle_rad)
    except MakeError as error:
        raise MakeError(f"{pose}: {error}") from error
    return replace(trajectory, position_preload_rad=preload.position_rad), preload.margins
