"""From a wielding path to the trajectory that is exported: timed, and with its grip preload."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fpcad.make.preload.margins import Margins
from fpcad.make.preload.tighten import tightened
from fpcad.make.trajectory import Trajectory, build_trajectory
from fpcad.model.geometry import HandGeometry
from fpcad.model.transmission import hand_transmission, single_axis_speed_limits
from fpcad.solve.attempt import Workbench
from fpcad.spec.catalogue import motor
from fpcad.wield.evaluate import contact_projector
from fpcad.wield.path import WieldingPath

Array = NDArray[np.float64]


def gripping_trajectory(
    bench: Workbench, design: Array, geometry: HandGeometry, path: WieldingPath
) -> tuple[Trajectory, Margins]:
    """The trajectory along a path of a hand, and how far its grip is from slipping.

    Args:
        bench: formulas of the spec's poses.
        design: (n_d,) [mm, rad].
        geometry: of that hand.
        path: one of its paths.

    Raises:
        MakeError: contact cannot be kept along the path, or nothing holds the tool there.
    """
    spec = bench.spec
    A = hand_transmission(spec.motors.transmission, len(geometry.fingers))
    speed = single_axis_speed_limits(A, motor(spec.motors.type).no_load_speed_rad_s)
    projector = contact_projector(bench, design, path)
    trajectory = build_trajectory(path, spec, geometry, projector, speed)
    return tightened(trajectory, spec, path.pose, geometry, path.hand_in_tool)
