"""What abduction leaves room for at the MCP joint: the bone swings between pulleys, cross and strands.

All in the proximal bone's frame [mm], for the widest abduction to either side [rad].
"""

from __future__ import annotations

import math

from fpcad.make.parts.mcp_dimensions import PIVOT_HOLD_MM, Mcp

SPOKE_BACK_MM = 0.9
"""Behind it, all of discs and arms that is wider than the hubs leaves the IP strands free when abducted."""


def neck_start(mcp: Mcp) -> float:
    """Where along x [mm] the proximal bone's neck begins: beyond the cross, however far it is abducted."""
    return mcp.cross_reach + mcp.gap


def neck_half_width(mcp: Mcp, widest_abduction: float) -> float:
    """Half width of the neck: abducted [rad], it passes between the input pulleys up to their rims."""
    cosine, sine = math.cos(widest_abduction), math.sin(widest_abduction)
    return (mcp.pulley_inner - mcp.gap) * cosine - (mcp.pulley_rim + mcp.gap) * sine


def spoke_back(mcp: Mcp, widest_abduction: float) -> float:
    """Where along x [mm], beside the hubs, all that is abducted begins: the IP strands pass behind."""
    cosine, sine = math.cos(widest_abduction), math.sin(widest_abduction)
    return SPOKE_BACK_MM * cosine + mcp.drum_side * sine


def horn_inner(mcp: Mcp, widest_abduction: float) -> float:
    """Inner |y| [mm] of the discs' horns: abducted, they pass beside the IP strands."""
    cosine, sine = math.cos(widest_abduction), math.sin(widest_abduction)
    return (mcp.drum_side + mcp.strand + mcp.gap / 2 + mcp.horn_back * sine) / cosine


def arm_end(mcp: Mcp, widest_abduction: float) -> float:
    """Where along x [mm] the arms end: where the neck may be wide."""
    return beyond_pulleys(mcp, widest_abduction, neck_half_width(mcp, widest_abduction))


def between_strands(mcp: Mcp, widest_abduction: float, x: float) -> float:
    """Half width [mm] at `x` of what swings between the motors' strands beside the input pulleys."""
    room = mcp.pulley_side - mcp.strand - mcp.gap
    return (room - x * math.sin(widest_abduction)) / math.cos(widest_abduction)


def arm_outline(mcp: Mcp, widest_abduction: float) -> list[tuple[float, float]]:
    """Corners (x, y) [mm] of the bone's arms above and below the pulleys, beside the hubs.

    They are as wide as the discs, or as the motors' strands let them swing.
    """
    start, end = spoke_back(mcp, widest_abduction), arm_end(mcp, widest_abduction)
    slope, widest = math.tan(widest_abduction), between_strands(mcp, widest_abduction, 0.0)
    narrows = (widest - mcp.disc_rim) / slope if slope > 0 else end
    corners = [
        (x, min(mcp.disc_rim, between_strands(mcp, widest_abduction, x)))
        for x in sorted({start, min(max(narrows, start), end), end})
    ]
    return [*corners, *((x, -y) for x, y in reversed(corners))]


def beyond_pulleys(mcp: Mcp, widest_abduction: float, half_width: float) -> float:
    """Where along x [mm] a neck of this half width may begin that is abducted beyond the pulleys."""
    cosine, sine = math.cos(widest_abduction), math.sin(widest_abduction)
    return (mcp.pulley_rim + mcp.gap + half_width * sine) / cosine


def reasons(mcp: Mcp, root: float, widest_abduction: float) -> list[str]:
    """Why the differential has no room in a sphere of radius `root` [mm], nothing where it has."""
    found = []
    pulley = math.hypot(mcp.pulley_rim, mcp.pulley_outer)
    disc = math.hypot(mcp.disc_outer, mcp.disc_rim)
    for what, needs in (("input pulley", pulley), ("output disc", disc), ("hub", mcp.cavity)):
        if needs > root - mcp.gap:
            found.append(f"{what} reaches {needs:.1f} mm from the root, its sphere has {root:g} mm")
    rooms = (
        ("cheek of the MCP cross", mcp.cheek_outer - mcp.cheek_inner, 1.4),
        ("bridge of the MCP cross", mcp.bridge_outer - mcp.bridge_inner, PIVOT_HOLD_MM),
        ("neck of the proximal bone", neck_half_width(mcp, widest_abduction), 1.6),
        ("wall of the IP drum", mcp.drum_radius - mcp.strand - mcp.axle - mcp.slip, 0.8),
    )
    for what, has, needs in rooms:
        if has < needs - 1e-9:
            found.append(f"{what}: {has:.2f} mm are left, {needs:g} mm are needed")
    return found
