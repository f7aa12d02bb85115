"""How tight the hand holds the tool, and how soft it is: what turns touching into gripping."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, Field

from fpcad.spec.base import Fraction, NonNegative, Positive, SpecModel, Vector3, rejection


def _some_direction(direction: Vector3) -> Vector3:
    if not any(direction):
        raise rejection("a direction: three numbers, not all of them 0")
    return direction


class Grip(SpecModel):
    """The grip preload of the exported trajectories: forces asked for, and stiffnesses assumed."""

    min_normal_force_n: Positive = 1.5
    """Least force [N] with which each contact presses on the tool."""
    stiffness_share: Annotated[float, Field(ge=0, lt=1)] = 0.1
    """Share of the grip's stiffness that its own forces must leave, for a tool that soft fingers
    squeeze hard snaps away; where less were left, forces fall below their least."""
    cone_share: Fraction = 0.5
    """Share of the friction cone that the planned forces use; the rest is for what is not planned."""
    motor_share: Fraction = 0.9
    """Share of the motors' continuous torque that gripping may take."""
    tool_mass_g: NonNegative = 50.0
    """Mass of the tool that the forces carry [g]."""
    gravity: Annotated[Vector3, AfterValidator(_some_direction)] = (0.0, 0.0, -1.0)
    """Direction of gravity in the hand's frame H; the default holds the back of the hand up."""
    tendon_stiffness_n: Positive = 12_000.0
    """Axial stiffness EA of a tendon [N]: force for a unit of strain. Bedded-in 0.6 mm Dyneema braid
    by default, an estimate until it is measured."""
    tendon_length_mm: Positive = 185.0
    """Free length of a tendon from spool to pulley [mm]. The mean of clay's loops as modelled by default:
    150 to 160 for the MCP joint, 210 to 260 for the IP joint with the finger's own strand, see
    hand/transmission.yaml."""
    servo_stiffness_nm_rad: Positive | None = None
    """Stiffness of a servo at its shaft [N m/rad]; estimated from its catalogue row by default."""
    skin_stiffness_n_mm: Positive = 30.0
    """Stiffness of the skin under a contact [N/mm]."""
    smoothing_deg: Positive = 3.0
    """Turn of the tool [deg] over which forces are kept from jumping."""
