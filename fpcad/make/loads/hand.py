"""All loads of a hand along its trajectories."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from fpcad.make.loads.bones import Bones
from fpcad.make.loads.cases import GRIPPING, MOST, Case, grip_cases
from fpcad.make.loads.finger import FingerForces, Touched, finger_forces
from fpcad.make.loads.motors import MOTORS, motion_loads, spool_torques, tip_load, torque_load
from fpcad.make.loads.pins import Borne, finger_pins
from fpcad.make.loads.strands import Tensions, slack_from_nmm, tensions
from fpcad.make.loads.table import ANY, Load
from fpcad.make.parts.assembly import Assembly
from fpcad.make.parts.catalogue import Tendon, lookup
from fpcad.make.parts.dimensions import Dimensions, finger_dimensions
from fpcad.make.parts.materials import bone_strength, cross_strength
from fpcad.make.parts.mcp_dimensions import TENDON
from fpcad.make.trajectory import Trajectory
from fpcad.model.geometry import HandGeometry
from fpcad.spec.catalogue import motor
from fpcad.spec.hardware import Print
from fpcad.spec.schema import Spec
from fpcad.units import DEG_PER_RAD, NM_PER_NMM

Array = NDArray[np.float64]

STALLED = "at stall"


def hand_loads(
    spec: Spec,
    assembly: Assembly,
    geometry: HandGeometry,
    trajectories: Mapping[str, Trajectory],
) -> list[Load]:
    """The worst of each kind, for every pose and case; see docs/loads.md."""
    if not trajectories:
        return []
    d = finger_dimensions(spec, geometry)
    bones = Bones(d, {part.name: part.mesh for part in assembly.parts})
    found = []
    for pose, trajectory in trajectories.items():
        found += motion_loads(spec, pose, trajectory)
        for case in grip_cases(spec, geometry, pose, trajectory):
            found.append(tip_load(spec, case) if case.name == MOST else torque_load(spec, case))
            if case.name == GRIPPING:
                found.append(_slack_load(spec, case))
            found += _worst(_finger_loads(spec, geometry, d, bones, case))
    return [*found, _stall_load(spec)]


def _finger_loads(
    spec: Spec, geometry: HandGeometry, d: Dimensions, bones: Bones, case: Case
) -> Iterator[Load]:
    """Every load of every finger in one case, the worst of its states each."""
    torques = spool_torques(spec, case)
    spool = spec.motors.transmission.spool_radius_mm
    for number, finger in enumerate(geometry.fingers):
        own = slice(3 * number, 3 * number + 3)
        touched = touching(case, finger, case.joints_rad[:, own])
        tension = tensions(torques[:, own], spool)
        forces = finger_forces(d, geometry.T_palm_root[finger], touched, tension)
        borne = [
            *_strands(tension),
            *finger_pins(d, forces, spec.print),
            *_stresses(spec.print, bones, forces, touched.joints_rad),
        ]
        for item in borne:
            worst = int(item.value.argmax())
            at = float(case.angle_rad[worst] * DEG_PER_RAD)
            most = float(item.value[worst]), item.limit, item.unit
            yield Load(case.pose, case.name, item.what, f"{finger} {item.where}", *most, at)


def touching(case: Case, finger: str, joints: Array) -> Touched:
    """What the tool does to one finger in the states of a case; the finger's joints are (K, 3)."""
    for k, link in enumerate(case.links):
        if link.finger == finger:
            own = case.points_mm[:, k], -case.forces_n[:, k]
            return Touched(joints, *own, on_distal=link.link == "distal")
    nothing = np.zeros_like(joints)
    return Touched(joints, nothing, nothing, on_distal=True)


def _strands(tension: Tensions) -> Iterator[Borne]:
    row = lookup("tendons", Tendon, TENDON)
    limit = row.breaking_n * row.knot_share
    for k, name in enumerate(MOTORS):
        most = np.maximum(tension.flexor[:, k], tension.extensor[:, k])
        yield Borne("strand", f"{name} strand", most, limit, "N")
    transfer = np.maximum(tension.palmar.max(axis=1), tension.dorsal)
    yield Borne("strand", "transfer strand", transfer, limit, "N")
    inside = np.maximum(tension.ip_flexor, tension.ip_extensor)
    yield Borne("strand", "IP strand", inside, limit, "N")


def _stresses(
    settings: Print, bones: Bones, forces: FingerForces, joints: Array
) -> Iterator[Borne]:
    limit = bone_strength(settings).stress_mpa
    for where, stress in bones.stresses(forces, joints).items():
        yield Borne("bone", where, stress, limit, "MPa")
    bridge = bones.bridge_stress(forces)
    yield Borne(
        "cross", "bridge of the MCP cross", bridge, cross_strength(settings).stress_mpa, "MPa"
    )


def _worst(loads: Iterator[Load]) -> list[Load]:
    """Of what all fingers have alike, the finger that bears most."""
    worst: dict[tuple[str, str], Load] = {}
    for load in loads:
        kind = load.what, load.where.split(" ", 1)[1]
        if kind not in worst or load.load > worst[kind].load:
            worst[kind] = load
    return list(worst.values())


def _slack_load(spec: Spec, case: Case) -> Load:
    """The torque at a spool against that beyond which the other strand of its loop hangs."""
    torque = np.abs(spool_torques(spec, case))
    state, worst = np.unravel_index(int(torque.argmax()), torque.shape)
    limit = slack_from_nmm(spec.motors.transmission.spool_radius_mm) * NM_PER_NMM
    where, at = f"{MOTORS[worst % 3]} loop", float(case.angle_rad[state] * DEG_PER_RAD)
    most = float(torque[state, worst]) * NM_PER_NMM
    return Load(case.pose, case.name, "slack", where, most, limit, "N m", at)


def _stall_load(spec: Spec) -> Load:
    """What a strand bears while its motor pushes against a stop with all its torque."""
    row, tendon = motor(spec.motors.type), lookup("tendons", Tendon, TENDON)
    gear = max(spec.motors.wiring.ratios(tuple(spec.motors.wiring.gear_ratios)), default=1.0)
    pull = gear * row.stall_torque_nm / NM_PER_NMM / spec.motors.transmission.spool_radius_mm
    limit = tendon.breaking_n * tendon.knot_share
    return Load(ANY, STALLED, "strand", "motor strand", pull, limit, "N")
