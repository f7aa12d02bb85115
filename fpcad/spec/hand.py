"""The hand: template, parameter ranges, joint limits and the palm's envelope."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from fpcad.spec.base import (
    Interval,
    Name,
    NonNegative,
    Positive,
    SpecModel,
    Vector3,
    rejection,
)
from fpcad.spec.templates import SiteName, TemplateName


class ParameterRange(SpecModel):
    """One design parameter: sampled between `min` and `max`, or held at `value`."""

    min: float | None = None
    """Least value, in the unit of the parameter's name."""
    max: float | None = None
    """Greatest value, in the unit of the parameter's name."""
    value: float | None = None
    """The one value of a parameter that is not sampled."""

    @model_validator(mode="after")
    def _range_or_value(self) -> ParameterRange:
        ranged = self.min is not None and self.max is not None
        if ranged == (self.value is not None) or (self.min is None) != (self.max is None):
            raise rejection("either both `min` and `max`, or `value` alone")
        if self.min is not None and self.max is not None and self.min >= self.max:
            raise rejection(f"a number greater than min = {self.min:g}", at="max")
        return self

    @property
    def bounds(self) -> tuple[float, float]:
        """Least and greatest value, equal for a parameter that is held."""
        if self.value is not None:
            return self.value, self.value
        assert self.min is not None and self.max is not None
        return self.min, self.max


class PalmCapsule(SpecModel):
    """A capsule of the palm between two sites."""

    kind: Literal["capsule"]
    """Primitive: `capsule` or `sphere`."""
    name: Name
    """Name of the primitive in reports and in the URDF."""
    radius_mm: Positive
    """Radius [mm]."""
    start: SiteName
    """Site at one end of the axis."""
    end: SiteName
    """Site at the other end of the axis."""
    offset_mm: Vector3 = (0.0, 0.0, 0.0)
    """Shift of the whole primitive in the hand frame H [mm]."""


class PalmSphere(SpecModel):
    """A sphere of the palm at one site; the finger that roots there is exempt from touching it."""

    kind: Literal["sphere"]
    """Primitive: `capsule` or `sphere`."""
    name: Name
    """Name of the primitive in reports and in the URDF."""
    radius_mm: Positive
    """Radius [mm]."""
    at: SiteName
    """Site at the centre."""
    offset_mm: Vector3 = (0.0, 0.0, 0.0)
    """Shift of the centre in the hand frame H [mm]."""


PalmPrimitive = Annotated[PalmCapsule | PalmSphere, Field(discriminator="kind")]


class Hand(SpecModel):
    """Hand template with everything that it leaves open."""

    template: TemplateName
    """Kinematic template; `anthropomorphic_4f` is the only one so far."""
    finger_length_mm: Positive = 100.0
    """Length of each finger from root to apex [mm], shared by its proximal and distal link."""
    root_gap_mm: NonNegative = 2.0
    """Least gap between two neighbouring fingers' roots [mm]; designs below it are not tried."""
    parameters: dict[str, ParameterRange]
    """Range or value of each design parameter of the template."""
    joint_limits_deg: dict[str, Interval]
    """Range of each joint of a finger [deg]."""
    rest_posture_deg: dict[str, float] = {}
    """Posture that fingers without contact are pulled to softly [deg]; straight by default."""
    palm: tuple[PalmPrimitive, ...] = ()
    """Solids that stand for the palm in collision checks and that its parts must fit in."""
