"""From a wielding path to the trajectory that is exported: timed, and with its grip preload."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from fpcad.errors import MakeError
from fpcad.make.preload.margins import Margins
from fpcad.make.preload.tighten import tightened
from fpcad.make.quintic import Offset
from fpcad.make.trajectory import Trajectory, build_trajectory
from fpcad.model.geometry import HandGeometry
from fpcad.model.transmission import hand_transmission, single_axis_speed_limits
from fpcad.solve.attempt import Workbench
from fpcad.spec.catalogue import motor
from fpcad.units import RAD_PER_DEG
from fpcad.wield.evaluate import contact_projector
from fpcad.wield.path import WieldingPath

Array = NDArray[np.float64]

PACING_ROUNDS = 4
"""How often a trajectory is timed anew for the speed of its grip, which is known only afterwards."""
PACE_TOLERANCE = 0.02
"""Excess over that speed [-] that is left: other knots, other interpolation."""


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
    offset = None
    for _ in range(PACING_ROUNDS):
        trajectory = build_trajectory(path, spec, geometry, projector, speed, offset)
        gripping, margins = tightened(trajectory, spec, path.pose, geometry, path.hand_in_tool)
        fastest = gripping.grip_speed_rad_s()
        if fastest <= spec.motion.grip_speed_deg_s * RAD_PER_DEG * (1 + PACE_TOLERANCE):
            return gripping, margins
        offset = _offset_over_turn(gripping)
    raise MakeError(
        f"{path.pose}: the grip's goals move at {np.degrees(fastest):.3g} deg/s against the joints, "
        f"motion.grip_speed_deg_s allows {spec.motion.grip_speed_deg_s:g}"
    )


def _offset_over_turn(gripping: Trajectory) -> Offset:
    """How far the goals lie beyond the joints, over the tool's turn."""
    assert gripping.position_preload_rad is not None
    turned, first = np.unique(gripping.tool.angle_rad, return_index=True)
    offset = (gripping.position_preload_rad - gripping.position_rad)[first]
    return PchipInterpolator(turned, offset)
