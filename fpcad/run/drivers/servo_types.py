"""What a maker's servos have in common: a model, registers side by side, and what they tell."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class ServoModel:
    """One type of servo, as its maker numbers it."""

    name: str
    stall_nm: float
    stall_ma: float


@dataclass(frozen=True)
class Reading:
    """One servo's registers, read."""

    counts: int
    current_ma: float
    temperature_c: float


@dataclass(frozen=True)
class Block:
    """Neighbouring registers."""

    address: int
    length: int
