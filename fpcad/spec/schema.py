"""The whole spec: one frozen value that every later layer reads."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field, field_validator

from fpcad.spec.base import Name, SpecModel, rejection
from fpcad.spec.grip import Grip
from fpcad.spec.hand import Hand
from fpcad.spec.hardware import Motion, Motors, Print
from fpcad.spec.mount import Mount
from fpcad.spec.pose import Initial, Pose
from fpcad.spec.process import Bounds, Path, Sampling, Selection, Solver, Statics
from fpcad.spec.tool import CylinderTool


class Spec(SpecModel):
    """A tool, a hand template and foundational poses, and how to make a hand of them."""

    fpcad: Literal[1]
    """Version of the spec format."""
    name: Name
    """Name of the design; its build lies in build/NAME."""
    description: str = ""
    """What the design is for, in words."""
    tool: CylinderTool
    """The tool that the hand wields."""
    hand: Hand
    """The hand template and its free parameters."""
    poses: dict[Name, Pose] = Field(min_length=1)
    """Foundational poses by name."""
    initial: Initial | None = None
    """The hand to start from; without it a multi-start search finds one."""
    statics: Statics = Statics()
    """When a pose counts as held."""
    bounds: Bounds = Bounds()
    """Bounds on poses and paths."""
    solver: Solver = Solver()
    """How poses are solved."""
    sampling: Sampling = Sampling()
    """How hands are sampled."""
    path: Path = Path()
    """How the tool is turned."""
    selection: Selection = Selection()
    """How one hand is chosen."""
    motors: Motors = Motors()
    """What drives the joints."""
    motion: Motion = Motion()
    """Limits of the exported trajectories."""
    grip: Grip = Grip()
    """How tight the exported trajectories hold the tool."""
    print: Print = Print()
    """How the parts are printed."""
    mount: Mount = Mount()
    """How the hand is fixed, and where its motors are."""

    @field_validator("fpcad", mode="before")
    @classmethod
    def _whole_version(cls, version: Any) -> Any:
        if isinstance(version, (bool, float)):  # both equal 1 in Python, neither is meant
            raise rejection("1")
        return version
