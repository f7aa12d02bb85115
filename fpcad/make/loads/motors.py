"""Loads of the motors: turn, speed, torque, and the tip force that they hold."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fpcad.make.loads.cases import MOST, Case
from fpcad.make.loads.motion import motor_motion
from fpcad.make.loads.table import Load
from fpcad.make.parts.mcp_dimensions import SPOOL_TURN_RAD
from fpcad.make.trajectory import Trajectory
from fpcad.model.transmission import hand_transmission, motor_torques
from fpcad.spec.catalogue import motor
from fpcad.spec.schema import Spec
from fpcad.spec.templates import TEMPLATES
from fpcad.units import DEG_PER_RAD, NM_PER_NMM

Array = NDArray[np.float64]

MOTORS = ("m1", "m2", "m3")
MOVING, ALONG = "moving", "all along"


def motor_names(spec: Spec) -> list[str]:
    """All motors, finger by finger."""
    return [f"{f}_{m}" for f in TEMPLATES[spec.hand.template].fingers for m in MOTORS]


def motion_loads(spec: Spec, pose: str, trajectory: Trajectory) -> list[Load]:
    """The motor that turns farthest, and the one that turns fastest, on a trajectory."""
    row, fingers = motor(spec.motors.type), TEMPLATES[spec.hand.template].fingers
    motion = motor_motion(trajectory, hand_transmission(spec.motors.transmission, len(fingers)))
    gears = np.array(spec.motors.wiring.ratios(fingers))
    span = motion.high_rad - motion.low_rad
    names = [f"{name} ({row.type})" for name in motor_names(spec)]
    kinds = (
        ("spool turn", span * DEG_PER_RAD, SPOOL_TURN_RAD * DEG_PER_RAD, "deg"),
        ("motor turn", gears * span * DEG_PER_RAD, row.position_range_deg, "deg"),
        ("motor speed", gears * motion.speed_rad_s, row.no_load_speed_rad_s, "rad/s"),
    )
    found = []
    for what, values, limit, unit in kinds:
        worst = int(values.argmax())
        found.append(Load(pose, MOVING, what, names[worst], float(values[worst]), limit, unit))
    return found


def spool_torques(spec: Spec, case: Case) -> Array:
    """Torque (N, n_motors) [N mm] at each spool in the states of a case."""
    A = hand_transmission(spec.motors.transmission, len(TEMPLATES[spec.hand.template].fingers))
    return motor_torques(A, case.torque_nmm)


def torque_load(spec: Spec, case: Case) -> Load:
    """The motor that must give most in a case."""
    row, fingers = motor(spec.motors.type), TEMPLATES[spec.hand.template].fingers
    gears = np.array(spec.motors.wiring.ratios(fingers))
    torque = np.abs(spool_torques(spec, case)) * NM_PER_NMM / gears
    state, worst = np.unravel_index(int(torque.argmax()), torque.shape)
    where, at = f"{motor_names(spec)[worst]} ({row.type})", case.angle_rad[state] * DEG_PER_RAD
    most = float(torque[state, worst]), row.continuous_torque_nm
    return Load(case.pose, case.name, "motor torque", where, *most, "N m", float(at))


def tip_load(spec: Spec, case: Case) -> Load:
    """The tip force that is asked for, against the least that the motors hold along the path."""
    assert case.name == MOST
    worst = int(case.tip_force_n.argmin())
    asked, held = spec.poses[case.pose].tip_force_n, float(case.tip_force_n[worst])
    where, at = f"all motors ({spec.motors.type})", float(case.angle_rad[worst] * DEG_PER_RAD)
    return Load(case.pose, ALONG, "tip force", where, asked, held, "N", at)
