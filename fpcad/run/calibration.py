"""What was measured on one hand: where its motors' zeros are, which way they turn, how soft they pull.

The design says how a hand should be; this file says how one is. So it lies beside the designs, survives
every new build, and is never written by hand. It is bound to the transmission that it was measured on.
"""

from __future__ import annotations

import hashlib
import io
import math
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from fpcad.run.errors import CalibrationError
from fpcad.run.firmware_setup import FirmwareSetup
from fpcad.run.limits import JointLimits
from fpcad.store import write_whole

Array = NDArray[np.float64]

VERSION = 1
RANGE_TOLERANCE = 0.1
"""Largest difference of a joint's range from the design's, as a part of the latter."""
_LARGEST_ZERO_RAD = 512 * 2 * math.pi
"""Beyond what a servo counts."""
_STIFFNESS_NM_RAD = (0.05, 1000.0)
_HEADER = """\
# Measured by fpcad on one hand; not part of its design. `fpcad calibrate` writes it anew.
# zero_rad: the motor's angle when its spool is at 0; lower_rad, upper_rad: the joint's end stops.
"""


@dataclass(frozen=True)
class Calibration:
    """Measured values of n motors and n joints."""

    driver: str
    transmission_sha256: str
    motors: tuple[str, ...]
    joints: tuple[str, ...]
    zero_rad: Array  # (n,) of the motors
    sign: Array  # (n,) of 1 and -1
    stiffness_nm_rad: Array  # (n,) at the spools, nan where not measured
    lower_rad: Array  # (n,) end stops of the joints, as found
    upper_rad: Array  # (n,)

    def require_plausible(self, limits: JointLimits) -> None:
        """Raise :class:`CalibrationError` where a value cannot be true of this hand."""
        for name, zero, sign, soft in zip(
            self.motors, self.zero_rad, self.sign, self.stiffness_nm_rad, strict=True
        ):
            if not abs(zero) <= _LARGEST_ZERO_RAD or sign not in (-1, 1):
                raise _implausible(f"{name}: zero at {zero:g} rad, sign {sign:g}")
            if not np.isnan(soft) and not _STIFFNESS_NM_RAD[0] <= soft <= _STIFFNESS_NM_RAD[1]:
                raise _implausible(f"{name}: stiffness of {soft:g} N m/rad")
        design = designed_ranges(limits)
        for name, low, high, wanted in zip(
            self.joints, self.lower_rad, self.upper_rad, design, strict=True
        ):
            require_range(name, high - low, wanted, _implausible)


def designed_ranges(limits: JointLimits) -> Array:
    """Angles (n,) between the joints' end stops, which lie a little beyond the limits [rad]."""
    return limits.upper_rad - limits.lower_rad + 2 * FirmwareSetup.end_stops_rad


def require_range(name: str, found_rad: float, wanted_rad: float, error: Any) -> None:
    """Raise `error` with a sentence where a joint's range is not the design's within 10 %."""
    if not abs(found_rad - wanted_rad) <= RANGE_TOLERANCE * wanted_rad:
        raise error(
            f"{name}: turns {math.degrees(found_rad):.0f} degrees between its ends, the design has "
            f"{math.degrees(wanted_rad):.0f}; look at sign, tendon and what may block it"
        )


def transmission_hash(configuration: bytes) -> str:
    """What binds a calibration to a build's transmission."""
    return hashlib.sha256(configuration).hexdigest()


def calibration_file(spec_file: Path, name: str) -> Path:
    """Where the calibration of a design's hand lies: `calibration/NAME.yaml` beside the design."""
    return spec_file.parent / "calibration" / f"{name}.yaml"


def write_calibration(path: Path, calibration: Calibration, limits: JointLimits) -> None:
    """Write the file as a whole or not at all, and only if it is plausible."""
    calibration.require_plausible(limits)
    motors = {
        name: {"zero_rad": float(zero), "sign": int(sign)}
        | ({} if np.isnan(soft) else {"stiffness_nm_rad": float(soft)})
        for name, zero, sign, soft in zip(
            calibration.motors,
            calibration.zero_rad,
            calibration.sign,
            calibration.stiffness_nm_rad,
            strict=True,
        )
    }
    joints = {
        name: {"lower_rad": float(low), "upper_rad": float(high)}
        for name, low, high in zip(
            calibration.joints, calibration.lower_rad, calibration.upper_rad, strict=True
        )
    }
    yaml = YAML(typ="safe", pure=True)
    yaml.default_flow_style = None
    yaml.sort_base_mapping_type_on_output = False  # type: ignore[assignment]
    text = io.StringIO()
    document = {
        "calibration": VERSION,
        "measured": datetime.now(UTC).isoformat(timespec="seconds"),
        "driver": calibration.driver,
        "transmission_sha256": calibration.transmission_sha256,
        "motors": motors,
        "joints": joints,
    }
    yaml.dump(document, text)
    write_whole(path, _HEADER + text.getvalue())


def read_calibration(
    path: Path, motors: tuple[str, ...], limits: JointLimits, driver: str
) -> Calibration:
    """Read and check; :class:`CalibrationError` where it is not of this hand and driver."""
    if not path.is_file():
        raise CalibrationError(f"{path}: there is none yet; measure it with `fpcad calibrate`")
    try:
        data = YAML(typ="safe", pure=True).load(path.read_text(encoding="utf-8"))
        found = _from_plain(data, motors, limits.names)
    except (OSError, UnicodeDecodeError, YAMLError, KeyError, TypeError, ValueError) as error:
        reason = " ".join(str(error).split())[:120]
        raise CalibrationError(
            f"{path}: cannot be read ({type(error).__name__}: {reason}); measure it again"
        ) from error
    if found.transmission_sha256 != transmission_hash(limits.configuration):
        raise CalibrationError(
            f"{path}: measured on another transmission; measure this hand with `fpcad calibrate`"
        )
    if found.driver != driver:
        raise CalibrationError(
            f"{path}: measured with the driver {found.driver}, not {driver}; measure it again"
        )
    found.require_plausible(limits)
    return found


def _from_plain(data: Any, motors: tuple[str, ...], joints: tuple[str, ...]) -> Calibration:
    if data["calibration"] != VERSION:
        raise ValueError(f"version {data['calibration']}, not {VERSION}")
    for key, names in (("motors", motors), ("joints", joints)):
        if tuple(data[key]) != names:
            raise ValueError(f"{key} are {', '.join(data[key])}, not {', '.join(names)}")
    rows = [data["motors"][name] for name in motors]
    ends = [data["joints"][name] for name in joints]
    return Calibration(
        str(data["driver"]),
        str(data["transmission_sha256"]),
        motors,
        joints,
        np.array([float(row["zero_rad"]) for row in rows]),
        np.array([float(row["sign"]) for row in rows]),
        np.array([float(row.get("stiffness_nm_rad", np.nan)) for row in rows]),
        np.array([float(end["lower_rad"]) for end in ends]),
        np.array([float(end["upper_rad"]) for end in ends]),
    )


def _implausible(what: str) -> CalibrationError:
    return CalibrationError(f"implausible: {what}; measure it again")
