"""Random starts of a pose: fingers anywhere, the hand where their contacts fit the tool best."""

from __future__ import annotations

import casadi as ca
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fpcad.model.hand import LinkShape
from fpcad.model.pose import CONTACT_SIZE
from fpcad.model.surfaces import capsule_point, cylinder_point
from fpcad.solve.attempt import Workbench
from fpcad.solve.program import pose_bounds

Array = NDArray[np.float64]

DRAWS = 10
"""Random postures of which the best fitting one is taken."""
NORMAL_LENGTH_MM = 20.0
"""Length that a unit normal counts as beside positions when hand and tool are fitted."""


def random_start(bench: Workbench, pose: str, design: Array, random: np.random.Generator) -> Array:
    """A state y from which the pose's program may be solved, contacts inside their windows.

    Joints and contacts are drawn uniformly; the hand pose is the rigid motion that brings contact
    points and normals of fingers and tool together best (Kabsch). The best of several draws counts.
    """
    draws = [_draw(bench, pose, design, random) for _ in range(DRAWS)]
    return min(draws, key=lambda draw: draw[0])[1]


def _draw(
    bench: Workbench, pose: str, design: Array, random: np.random.Generator
) -> tuple[float, Array]:
    layout = bench.kernels[pose].layout
    lower, upper = pose_bounds(bench.spec, pose, layout)
    finite = np.isfinite(lower) & np.isfinite(upper)
    y = np.zeros(layout.size)
    y[finite] = random.uniform(lower[finite], upper[finite])
    contacts = y[layout.contacts].reshape(-1, CONTACT_SIZE)
    fingers, tools = [], []
    frames = _link_frames(bench, design, y[layout.joints])
    for contact, at in zip(bench.spec.poses[pose].contacts, contacts, strict=True):
        shape = bench.template.link_shape(contact.link, ca.DM(design))
        at[2] = random.uniform(*_arc_range(shape, bench.spec.bounds.apex_fraction))
        frame = frames[contact.finger][contact.link]
        fingers.append(capsule_point(shape, at[2], at[3]).moved(frame))
        tools.append(cylinder_point(bench.spec.tool, at[0], at[1]))
    y[layout.contacts] = contacts.ravel()
    P = np.array([np.array(point.p).ravel() for point in fingers])
    Q = np.array([np.array(ca.DM(point.p)).ravel() for point in tools])
    inward = -np.array([np.array(point.normal).ravel() for point in fingers])
    outward = np.array([np.array(ca.DM(point.normal)).ravel() for point in tools])
    to_tool = np.vstack([Q - Q.mean(0), NORMAL_LENGTH_MM * outward])
    from_hand = np.vstack([P - P.mean(0), NORMAL_LENGTH_MM * inward])
    rotation, misfit, *_ = Rotation.align_vectors(to_tool, from_hand)
    yaw, pitch, roll = rotation.as_euler("ZYX")
    y[layout.hand] = [*(Q.mean(0) - rotation.apply(P.mean(0))), roll, pitch, yaw]
    return float(misfit), y


def _link_frames(bench: Workbench, design: Array, joints: Array) -> dict:
    template, d = bench.template, ca.DM(design)
    u = joints.reshape(len(template.names.fingers), -1)
    return {
        finger: template.link_frames(finger, d, ca.DM(angles))
        for finger, angles in zip(template.names.fingers, u, strict=True)
    }


def _arc_range(shape: LinkShape, apex_fraction: float) -> tuple[float, float]:
    """Arc lengths [mm] between the skin's middle part and its far end."""
    end = float(shape.axis_length)
    tip = apex_fraction * float(shape.radius) * np.pi / 2 if shape.has_tip else 0.0
    return max(shape.hidden_start, 0.3 * end), end + tip
