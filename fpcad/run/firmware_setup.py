"""What the firmware is set up with for one hand: as text for the host build, as C for boards."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.run.framing import PROTOCOL_VERSION
from fpcad.run.knots import BUFFER_KNOTS
from fpcad.run.limits import PRELOAD_LIMIT_RAD, PRELOAD_SPEED_RAD_S, JointLimits, to_counts
from fpcad.run.motor_limits import MotorLimits, motor_limits_of
from fpcad.run.transmission import Transmission, transmission_of

GAIN = 1 << 24
"""Fixed point of the transmission's gains."""
TRACKING_LIMIT_RAD = 0.15


@dataclass(frozen=True)
class FirmwareSetup:
    """Everything that differs from hand to hand and from board to board."""

    limits: JointLimits
    boot_nonce: int = 1
    tick_hz: int = 250
    buffer_knots: int = BUFFER_KNOTS
    silence_us: int = 500_000
    homed: bool = True
    protocol: int = PROTOCOL_VERSION
    build: bytes = b"fpcad-fw"
    current_ma: int = 0
    """Largest current of one motor; 0: not guarded."""
    temperature_c: int = 0
    """Highest temperature of one motor; 0: not guarded."""
    hold_ma: int = 0
    """Largest current of one motor while the hand holds; 0: as always."""
    preload_limit_rad: float = PRELOAD_LIMIT_RAD
    """Largest angle that a grip's goals may lie beyond the path."""
    preload_rate_rad_s: float = PRELOAD_SPEED_RAD_S
    end_stops_rad: float = 0.03
    """How far the joints' end stops lie beyond the limits."""
    homing_speed_rad_s: float = 0.5
    homing_ma: int = 400
    """Largest current of one motor while the zeros are searched."""

    @property
    def motor_limits(self) -> MotorLimits:
        """What the motors may do, by the type that the limits' configuration names."""
        return motor_limits_of(self.limits)

    @property
    def transmission(self) -> Transmission:
        """The transmission that the limits' configuration holds; without one, one to one."""
        return transmission_of(self.limits)

    def numbers(self) -> dict[str, int | tuple[int, ...]]:
        """All numbers by their names in the firmware's structure."""
        wire, gears = self.limits.on_wire(), self.transmission
        return {
            "joints": len(self.limits.names),
            "homed": int(self.homed),
            "protocol": self.protocol,
            "tick_hz": self.tick_hz,
            "buffer_knots": self.buffer_knots,
            "boot_nonce": self.boot_nonce,
            "configuration": self.limits.hash(),
            "build": tuple(self.build.ljust(16, b"\0")[:16]),
            "silence_us": self.silence_us,
            "tracking_error": round(TRACKING_LIMIT_RAD * 1e6),
            "current_ma": self.current_ma,
            "temperature_c": self.temperature_c,
            "lower": wire.lower_urad,
            "upper": wire.upper_urad,
            "velocity": wire.velocity_urad_s,
            "acceleration": wire.acceleration_urad_s2,
            "hold_ma": self.hold_ma,
            **self._motor_numbers(),
            **self._homing_numbers(),
            "preload_limit": round(self.preload_limit_rad * 1e6),
            "preload_rate": round(self.preload_rate_rad_s * 1e6),
            "group": gears.group,
            "gain": _gains(gears, gears.matrix),
            "inverse": _gains(gears, np.linalg.inv(gears.matrix)),
            "offset": to_counts(gears.offset_rad),
        }

    def _motor_numbers(self) -> dict[str, int | tuple[int, ...]]:
        motors = self.motor_limits
        return {
            "motor_lower": to_counts(motors.lower_rad),
            "motor_upper": to_counts(motors.upper_rad),
            "motor_velocity": to_counts(motors.velocity_rad_s),
            "motor_acceleration": to_counts(motors.acceleration_rad_s2),
        }

    def _homing_numbers(self) -> dict[str, int | tuple[int, ...]]:
        return {
            "homing_lower": to_counts(self.limits.lower_rad - self.end_stops_rad),
            "homing_upper": to_counts(self.limits.upper_rad + self.end_stops_rad),
            "homing_speed": round(self.homing_speed_rad_s * 1e6),
            "homing_ma": self.homing_ma,
        }


def setup_text(setup: FirmwareSetup, start_rad: NDArray[np.float64]) -> str:
    """Lines `name numbers` that the host build reads; `start_rad` (n,): where its joints rest."""
    lines = [f"{name} {_spaced(value)}" for name, value in setup.numbers().items()]
    return "\n".join([*lines, f"start_rad {' '.join(repr(float(x)) for x in start_rad)}", ""])


def setup_source(
    setup: FirmwareSetup, start_rad: Sequence[float], zero_error_rad: Sequence[float] = ()
) -> str:
    """A C file that defines `HAND_SETUP` and, for simulated motors, where they are.

    `start_rad` (n,): where joints rest; `zero_error_rad` (n,): how far motors' zeros are off.
    """
    numbers = setup.numbers()
    group = setup.transmission.group
    for name in ("gain", "inverse"):
        flat = numbers[name]
        assert isinstance(flat, tuple)
        rows = [flat[i : i + group] for i in range(0, len(flat), group)]
        numbers[name] = tuple(_braces(row) for row in rows)  # type: ignore[assignment]
    nested = {name for names in _INNER.values() for name in names}
    lines = [f"    .{name} = {_c(value)}," for name, value in numbers.items() if name not in nested]
    for part, names in _INNER.items():
        body = "".join(f"        .{_within(part, n)} = {_c(numbers[n])},\n" for n in names)
        lines.append(f"    .{part} = {{\n{body}    }},")
    return (
        "/* Written by fpcad.run.firmware_setup for one hand. */\n"
        '#include "hand_setup.h"\n\n'
        "const struct hand_setup HAND_SETUP = {\n"
        + "\n".join(lines)
        + "\n};\n\n"
        + _floats("HAND_START_RAD", start_rad)
        + _floats("HAND_ZERO_ERROR_RAD", zero_error_rad)
    )


def _floats(name: str, values: Sequence[float]) -> str:
    inner = ", ".join(f"{float(x)!r}f" for x in values) or "0"
    return f"const float {name}[MAX_JOINTS] = {{{inner}}};\n"


_INNER = {
    "limits": ("lower", "upper", "velocity", "acceleration"),
    "motor_limits": ("motor_lower", "motor_upper", "motor_velocity", "motor_acceleration"),
    "transmission": ("group", "gain", "inverse", "offset"),
    "homing": ("homing_lower", "homing_upper", "homing_speed", "homing_ma"),
    "preload": ("preload_limit", "preload_rate"),
}
"""Numbers that stand in a structure within the setup."""


def _within(part: str, name: str) -> str:
    """A number's name within its structure: `homing_speed` of `homing` is `speed`."""
    inner = name.removeprefix(f"{part.removesuffix('_limits')}_")
    return "current_ma" if inner == "ma" else inner


def _gains(gears: Transmission, matrix: NDArray[np.floating]) -> tuple[int, ...]:
    return tuple(round(float(x) * GAIN) for x in gears.blocks(matrix).ravel())


def _spaced(value: int | tuple[int, ...]) -> str:
    return " ".join(map(str, value)) if isinstance(value, tuple) else str(value)


def _braces(values: Iterable[object]) -> str:
    return "{" + ", ".join(map(str, values)) + "}"


def _c(value: object) -> str:
    if isinstance(value, tuple):
        return _braces(value)
    return f"{value}ULL" if isinstance(value, int) and value >= 2**31 else str(value)
