"""The motors, flanges and metals that a spec may name, read from data/*.csv."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from fpcad.errors import SpecError
from fpcad.spec.faults import near_miss


@dataclass(frozen=True)
class Motor:
    """One row of the catalogue, at its supply voltage."""

    type: str
    maker: str
    supply_v: float
    continuous_torque_nm: float
    """Torque [N m] that it can hold for long; mostly an estimate, see `source`."""
    stall_torque_nm: float
    """Torque [N m] at which it stands still; it overheats within seconds."""
    no_load_speed_rad_s: float
    position_range_deg: float
    """How far it can be told to turn in all, in the mode that its driver uses."""
    mass_g: float
    source: str
    """Data sheet of the values, and what was estimated."""


def motor(type: str) -> Motor:
    """The catalogue's row of a motor type; :class:`fpcad.errors.SpecError` where it has none."""
    if type not in _rows():
        hint = near_miss(_rows(), type)
        raise SpecError(f'no motor "{type}"; allowed: {", ".join(_rows())}{hint}')
    return _rows()[type]


def motor_types() -> tuple[str, ...]:
    """All motor types in the order of the catalogue."""
    return tuple(_rows())


@cache
def flange_sizes() -> tuple[str, ...]:
    """Names of all flanges in the order of their table; their sizes are read where they are made."""
    return tuple(row["size"] for row in _table("flanges"))


@cache
def metal_sizes() -> tuple[str, ...]:
    """Names of all metals in the order of their table."""
    return tuple(row["size"] for row in _table("metals"))


@cache
def _rows() -> dict[str, Motor]:
    return {row["type"]: _motor(row) for row in _table("motors")}


def _table(name: str) -> list[dict[str, str]]:
    text = (files("fpcad") / "data" / f"{name}.csv").read_text(encoding="utf-8")
    return list(csv.DictReader(text.splitlines()))


def _motor(row: dict[str, str]) -> Motor:
    return Motor(
        type=row["type"],
        maker=row["maker"],
        supply_v=float(row["supply_v"]),
        continuous_torque_nm=float(row["continuous_torque_nm"]),
        stall_torque_nm=float(row["stall_torque_nm"]),
        no_load_speed_rad_s=float(row["no_load_speed_rad_s"]),
        position_range_deg=float(row["position_range_deg"]),
        mass_g=float(row["mass_g"]),
        source=row["source"],
    )
