"""What the hand is made of and driven by: motors, transmission, motion limits, printing."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from fpcad.spec.base import NonNegative, Positive, SpecModel
from fpcad.spec.catalogue import metal_sizes, motor_types
from fpcad.spec.wiring import Wiring

RIGID = "rigid"
"""Of what bones are printed from."""


class Transmission(SpecModel):
    """Tendon routing of one finger, the same for all."""

    spool_radius_mm: Positive = 6.5
    """Radius of the motors' spools [mm]."""
    input_pulley_radius_mm: Annotated[float, Field(gt=0, le=12)] = 6.5
    """Radius of the differential's two input pulleys, coaxial with flexion [mm]."""
    output_pulley_radius_mm: Positive = 6.0
    """Radius of the differential's output pulley, on the abduction axis [mm]."""
    idler_radius_mm: NonNegative = 3.0
    """Radius of the idlers that lead the IP strands across the MCP joint [mm]."""
    ip_pulley_radius_mm: Positive = 4.0
    """Radius of the IP joint's pulley [mm]."""


class Motors(SpecModel):
    """Motors, three a finger, and the way they pull."""

    type: Annotated[str, Field(json_schema_extra={"enum": [*motor_types()]})] = "STS3215-12V"
    """Row of the motor catalogue."""
    transmission: Transmission = Transmission()
    """Pulleys and spools."""
    wiring: Wiring = Wiring()
    """Ids, signs and gears on the servo bus."""


class Motion(SpecModel):
    """Limits that trajectories are slowed to."""

    tool_speed_deg_s: Positive = 30.0
    """Largest turning speed of the tool [deg/s]."""
    joint_speed_deg_s: Positive = 90.0
    """Largest speed of a joint [deg/s]."""
    joint_acceleration_deg_s2: Positive = 720.0
    """Largest acceleration of a joint [deg/s^2]."""
    grip_speed_deg_s: Annotated[float, Field(gt=0, le=50)] = 45.0
    """How fast a grip's goals may move against the joints [deg/s]; firmware refuses 57."""


class Print(SpecModel):
    """What the printers make, and from what."""

    skin_thickness_mm: Positive = 1.5
    """Thickness of the TPE skin [mm]."""
    skin_oversize_mm: NonNegative = 0.0
    """Enlargement of the skin beyond the contact surface [mm], against imprecise control."""
    clearance_mm: Positive = 0.2
    """Gap between parts that move against each other [mm]."""
    hold_mm: Annotated[float, Field(ge=-0.2, le=0.5)] = 0.05
    """What a printed hole is wider than the pin or bearing that it holds [mm]; try the coupon."""
    slip_mm: Annotated[float, Field(ge=0.0, le=0.5)] = 0.15
    """What a printed hole is wider than the pin that turns in it [mm]."""
    bone_density_g_cm3: Positive = 1.24
    """Density of the printed endoskeleton [g/cm^3]; PLA by default."""
    skin_density_g_cm3: Positive = 1.12
    """Density of the printed skin [g/cm^3]; TPE by default."""
    bed_mm: tuple[Positive, Positive, Positive] = (220.0, 220.0, 240.0)
    """Room of the printer: width, depth, height [mm]."""
    bone_wall_mm: Positive = 0.8
    """Thinnest wall of a rigid part [mm]: two lines of a 0.4 mm nozzle."""
    skin_wall_mm: Positive = 0.8
    """Thinnest wall of a skin [mm]."""
    bone_strength_mpa: Positive = 43.7
    """Normal stress [MPa] at which a rigid part breaks along its layers, as bones are printed to be
    bent; PLA filament by default, of which 52 % are left across layers (doi 10.1089/3dp.2020.0109)."""
    bone_bearing_mpa: Positive = 36.4
    """Pressure [MPa] at which a pin crushes a rigid part; the compressive strength of PLA printed half
    full by default (Scientific Reports 2025, doi 10.1038/s41598-025-94446-8)."""
    cross_material: Annotated[str, Field(json_schema_extra={"enum": [RIGID, *metal_sizes()]})] = (
        "17-4PH"
    )
    """What the MCP crosses are of: a metal, made to order from parts/step/mcp_cross.step, or `rigid`,
    printed like the bones, which does not bear the abduction pins of a strong grip (docs/loads.md)."""
    safety_factor: Annotated[float, Field(ge=1)] = 2.0
    """What strengths are divided by before loads are compared with them [-]."""
    overhang_deg: Annotated[float, Field(ge=0, lt=90)] = 45.0
    """Largest angle from the vertical at which a face is printed without support [deg]."""
    mesh_tolerance_mm: Annotated[float, Field(gt=0, le=1)] = 0.05
    """Largest chordal error of the STL files [mm]."""
    mesh_angle_deg: Annotated[float, Field(gt=0, le=45)] = 11.5
    """Largest angle between neighbouring facets of a curved face [deg]."""
