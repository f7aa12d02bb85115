"""What a simulated trial is: masses, loads, friction, errors, and the steps of its clock."""

from __future__ import annotations

from dataclasses import dataclass

TIME_STEP_S = 5e-4
CONTROL_PERIOD_S = 4e-3
"""Period at which motors get targets, as the firmware gives them."""


@dataclass(frozen=True)
class Trial:
    """One experiment with a hand and its tool."""

    tool_mass_kg: float = 0.02
    tip_force_n: float = 0.0
    """Force at the tip against the turning."""
    limited: bool = True
    """Whether motors stop at their continuous torque."""
    preload: float = 1.0
    """Factor on the grip preload: fingers that push too hard or too softly."""
    friction: float | None = None
    """Coefficient of friction; the spec's where None."""
    gravity: tuple[float, float, float] = (0.0, 0.0, -1.0)
    """Direction of gravity in the hand's frame H."""
    time_step_s: float = TIME_STEP_S
