"""Where a link is nearest to the tool: contact coordinates in closed form."""

from __future__ import annotations

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from fpcad.model.frames import Frame, rot_rpy
from fpcad.model.hand import LinkShape
from fpcad.model.surfaces import turned_tool
from fpcad.solve.attempt import Workbench

Array = NDArray[np.float64]


def nearest_contacts(
    bench: Workbench, pose: str, design: Array, hand: Array, turn: float, joints: Array
) -> Array:
    """Chart coordinates (n, 4) of the points of links and tool that are nearest to each other.

    In contact they are the contact coordinates: tool axial [mm], tool angle, arc length [mm],
    finger angle [rad]. For a posture a little off contact they are what contact comes next to,
    on either side of the seam between a link's cylinder and its tip.

    Args:
        design: (n_d,) [mm, rad].
        hand: (6,) pose of H in O [mm, rad].
        turn: tool angle [rad].
        joints: (n_u,) joint angles [rad].
    """
    template, d = bench.template, ca.DM(design)
    H = Frame(rot_rpy(*hand[3:]), ca.DM(hand[:3]))
    tool = turned_tool(bench.spec.poses[pose].turning, ca.DM(turn))
    angles = joints.reshape(len(template.names.fingers), -1)
    u = dict(zip(template.names.fingers, angles, strict=True))
    rows = []
    for contact in bench.spec.poses[pose].contacts:
        frames = template.link_frames(contact.finger, d, ca.DM(u[contact.finger]))
        shape = template.link_shape(contact.link, d)
        rows.append(_nearest(shape, H @ frames[contact.link], tool))
    return np.array(rows)


def _nearest(shape: LinkShape, link: Frame, tool: Frame) -> tuple[float, float, float, float]:
    """Coordinates on tool and link where their axes are nearest."""
    R_link, p_link = np.array(ca.DM(link.R)), np.array(ca.DM(link.p)).ravel()
    R_tool, p_tool = np.array(ca.DM(tool.R)), np.array(ca.DM(tool.p)).ravel()
    end, radius = float(shape.axis_length), float(shape.radius)
    along, axis, offset = R_link[:, 0], R_tool[:, 0], p_link - p_tool
    cosine = along @ axis
    sine_squared = 1.0 - cosine**2
    # Parallel axes are nearest everywhere; a path ends before they are parallel.
    foot = (cosine * (axis @ offset) - along @ offset) / max(sine_squared, np.finfo(float).eps)
    foot = float(np.clip(foot, 0.0, end))
    on_link = p_link + foot * along
    axial = float(axis @ (on_link - p_tool))
    gap = p_tool + axial * axis - on_link
    x, y, z = R_link.T @ gap
    beyond = radius * np.arctan2(x, np.hypot(y, z)) if shape.has_tip and foot == end else 0.0
    _, ty, tz = -(R_tool.T @ gap)
    return axial, float(np.arctan2(tz, ty)), foot + float(beyond), float(np.arctan2(y, -z))
