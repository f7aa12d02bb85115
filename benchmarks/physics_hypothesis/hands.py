"""The hands that are tried: sampled candidates, with bodies of even density instead of CAD."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import trimesh
from numpy.typing import NDArray

from fpcad.errors import MakeError
from fpcad.make.description import LinkBody
from fpcad.make.inertia import inertia_of
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

DENSITY_G_CM3 = 0.7
"""Mean density of finger capsules, which gives clay's first hand the masses of its CAD parts."""
MCP_RADIUS_MM = 5.0


def plain_bodies(geometry: HandGeometry) -> dict[str, LinkBody]:
    """Links as capsules of even density; modelling each hand's parts would take ten seconds."""
    distal_axis = geometry.distal_length_mm - geometry.radius_mm
    shapes = {
        "palm": trimesh.creation.icosphere(radius=20.0),
        "mcp": trimesh.creation.icosphere(radius=MCP_RADIUS_MM),
        "proximal": _capsule(geometry.proximal_length_mm, geometry.radius_mm),
        "distal": _capsule(distal_axis, geometry.radius_mm),
    }
    return {
        link: LinkBody(inertia_of([(shape, DENSITY_G_CM3)]), ()) for link, shape in shapes.items()
    }


def gripping_trajectory(
    bench: Workbench, design: Array, geometry: HandGeometry, path: WieldingPath
) -> tuple[Trajectory, Margins]:
    """What would be exported for a path, with its grip preload."""
    spec = bench.spec
    A = hand_transmission(spec.motors.transmission, len(geometry.fingers))
    speed = single_axis_speed_limits(A, motor(spec.motors.type).no_load_speed_rad_s)
    projector = contact_projector(bench, design, path)
    trajectory = build_trajectory(path, spec, geometry, projector, speed)
    return tightened(trajectory, spec, path.pose, geometry, path.hand_in_tool)


def trajectories(
    bench: Workbench, design: Array, geometry: HandGeometry, paths: Mapping[str, WieldingPath]
) -> tuple[dict[str, tuple[Trajectory, Margins]], dict[str, str]]:
    """Trajectories by pose, and by pose why there is none."""
    made, faults = {}, {}
    for pose, path in paths.items():
        try:
            made[pose] = gripping_trajectory(bench, design, geometry, path)
        except MakeError as error:
            faults[pose] = str(error)
    return made, faults


def _capsule(length: float, radius: float) -> trimesh.Trimesh:
    """A capsule from the origin along x [mm]."""
    capsule = trimesh.creation.capsule(height=length, radius=radius)
    turn = trimesh.transformations.rotation_matrix(np.pi / 2, [0.0, 1.0, 0.0])
    return capsule.apply_transform(turn)
