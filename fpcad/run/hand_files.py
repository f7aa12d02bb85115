"""What a run reads of a build: limits, transmission, the motors' names and how they are wired."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from fpcad.run.calibration import Calibration
from fpcad.run.errors import TrajectoryError
from fpcad.run.limits import JointLimits, read_limits
from fpcad.run.motor_map import MotorMap, Mounting
from fpcad.run.transmission import Transmission, read_transmission
from fpcad.spec import Spec
from fpcad.spec.templates import TEMPLATES
from fpcad.units import RAD_PER_DEG


@dataclass(frozen=True)
class HandFiles:
    """A built hand, as far as motors care."""

    spec: Spec
    folder: Path
    limits: JointLimits
    transmission: Transmission
    motors: tuple[str, ...]

    @property
    def urdf(self) -> Path:
        """The hand's description."""
        return self.folder / "hand" / "urdf" / f"{self.spec.name}.urdf"

    @property
    def numbers(self) -> tuple[int, ...]:
        """Bus ids of the motors."""
        return self.spec.motors.wiring.numbers(self._fingers)

    def motor_map(self, calibration: Calibration | None = None) -> MotorMap:
        """Joints to motors; without a calibration zeros are at 0 and signs as designed."""
        wiring = self.spec.motors.wiring
        ratio = np.array(wiring.ratios(self._fingers))
        if calibration is None:
            sign = np.array(wiring.directions(self._fingers), dtype=float)
            mounting = Mounting(np.zeros(len(self.motors)), sign, ratio)
        else:
            mounting = Mounting(calibration.zero_rad, calibration.sign, ratio)
        return MotorMap(self.limits.names, self.motors, self.transmission, mounting)

    @property
    def _fingers(self) -> tuple[str, ...]:
        return TEMPLATES[self.spec.hand.template].fingers


def read_hand(spec: Spec, folder: Path) -> HandFiles:
    """The hand in a build folder; :class:`TrajectoryError` where it is not all there."""
    urdf = folder / "hand" / "urdf" / f"{spec.name}.urdf"
    file = folder / "hand" / "transmission.yaml"
    acceleration = spec.motion.joint_acceleration_deg_s2 * RAD_PER_DEG
    limits = read_limits(urdf, acceleration, file)
    transmission = read_transmission(limits.configuration, limits.names)
    try:
        motors = YAML(typ="safe", pure=True).load(limits.configuration.decode("utf-8"))["motors"]
    except (YAMLError, UnicodeDecodeError, KeyError, TypeError) as error:
        raise TrajectoryError(f"{file}: names no motors: {error}") from error
    return HandFiles(spec, folder, limits, transmission, tuple(map(str, motors)))
