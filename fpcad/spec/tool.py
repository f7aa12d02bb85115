"""The tool that the hand wields."""

from __future__ import annotations

from typing import Literal

from pydantic import model_validator

from fpcad.spec.base import Positive, SpecModel, rejection


class CylinderTool(SpecModel):
    """A cylinder along the x axis of its frame O."""

    shape: Literal["cylinder"] = "cylinder"
    """Surface of the tool; `cylinder` is the only one so far."""
    radius_mm: Positive
    """Radius of the cylinder [mm]."""
    back_mm: float
    """x of the blunt end in O [mm]."""
    tip_mm: float
    """x of the working tip in O [mm], where the tip force acts."""

    @model_validator(mode="after")
    def _tip_lies_beyond_back(self) -> CylinderTool:
        if self.tip_mm <= self.back_mm:
            raise rejection(f"a number greater than back_mm = {self.back_mm:g}", at="tip_mm")
        return self
