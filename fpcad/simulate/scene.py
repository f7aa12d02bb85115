"""The hand's own MJCF with what a trial adds: rotors behind soft tendons, the tool, soft skin."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fpcad.errors import MakeError
from fpcad.make.grip import ContactLink
from fpcad.make.preload.stiffness import servo_stiffness_nm_rad, tendon_stiffness_nmm_rad
from fpcad.make.servo import servo_of
from fpcad.make.trajectory import Trajectory
from fpcad.model.transmission import hand_transmission
from fpcad.simulate.engine import mujoco
from fpcad.simulate.setting import Trial
from fpcad.spec import catalogue
from fpcad.spec.schema import Spec
from fpcad.units import M_PER_MM, NM_PER_NMM

Array = NDArray[np.float64]

GRAVITY_M_S2 = 9.81
TOOL, TIP, GIVER = "tool", "tip force", "giver"
"""Names of the tool, of the motor that stands for the force at its tip, and of what holds it first."""
TENDON_LOSS_S = 2e-3
"""Damping of a tendon over its stiffness: polymer braid damps a light finger's ringing by a third."""
IMPEDANCE = 0.9
"""MuJoCo's d of contacts: with it and the masses, `solref` follows from the skin's stiffness."""
FRICTION_IMPEDANCE = 20.0
"""MuJoCo's impratio: how much stiffer friction is than the skin, against creeping."""
NOSLIP_ITERATIONS = 10
"""Passes of MuJoCo's solver that takes what creep is left out of friction that sticks."""


@dataclass(frozen=True)
class Scene:
    """A compiled model and where its parts are."""

    model: Any
    """MjModel; its state is joints, rotors, tool, in groups by these indices."""
    joints: Array  # (n_u,) addresses in qpos
    rotors: Array  # (n_u,) addresses in qpos
    tool: int
    """Address of the tool's seven coordinates in qpos."""
    tool_body: int
    contacts: tuple[int, ...]
    """Geoms of the links that are to touch the tool, in the trajectory's order."""
    A: Array
    """(n_motors, n_u): motor angles are A times joint angles."""


def hand_spec(file: Path) -> Any:
    """MuJoCo's editable form of an exported hand, without its pictures.

    Raises :class:`MakeError` where the file is damaged.
    """
    try:
        return mujoco().MjSpec.from_file(str(file))
    except ValueError as error:
        raise MakeError(f"{file}: {error}") from error


def build_scene(hand: Any, spec: Spec, trajectory: Trajectory, trial: Trial) -> Scene:
    """The scene of a trial.

    Args:
        hand: MuJoCo's editable hand, which is used up.
        spec: friction, stiffness of tendons and skin.
        trajectory: which links touch, and the tool's shape.
        trial: what is tried.
    """
    mj = mujoco()
    for key in list(hand.keys):
        hand.delete(key)
    _options(hand, trial)
    for mesh_geom in [g for g in hand.geoms if g.type == mj.mjtGeom.mjGEOM_MESH]:
        hand.delete(mesh_geom)
    A = _rotors(hand, spec)
    _tool(hand, trajectory, trial)
    shapes = [g.name for g in hand.geoms if g.name and g.name != TOOL]
    friction = trial.friction if trial.friction is not None else spec.statics.friction
    for shape in shapes:
        pair = hand.add_pair(name=f"{shape} {TOOL}", geomname1=shape, geomname2=TOOL, condim=3)
        pair.friction = [friction, friction, 0.005, 0.0001, 0.0001]
    model = hand.compile()
    _soften(model, spec.grip.skin_stiffness_n_mm / M_PER_MM)
    if not trial.limited:
        model.actuator_forcelimited[:] = 0
    return _scene(model, trajectory, A)


def tool_inertia(mass: float, radius: float, length: float) -> tuple[float, float]:
    """Moments of inertia [kg m^2] of a solid cylinder about its axis and across it."""
    return mass * radius**2 / 2, mass * (3 * radius**2 + length**2) / 12


def _options(hand: Any, trial: Trial) -> None:
    mj, option = mujoco(), hand.option
    option.timestep = trial.time_step_s
    option.integrator = mj.mjtIntegrator.mjINT_IMPLICITFAST
    option.cone = mj.mjtCone.mjCONE_ELLIPTIC
    option.impratio = FRICTION_IMPEDANCE
    option.noslip_iterations = NOSLIP_ITERATIONS
    # MuJoCo would put a state that is no number back to the start, and a lost tool into the hand.
    option.disableflags |= mj.mjtDisableBit.mjDSBL_AUTORESET
    down = np.array(trial.gravity) / np.linalg.norm(trial.gravity)
    option.gravity = GRAVITY_M_S2 * down


def _rotors(hand: Any, spec: Spec) -> Array:
    """Put a rotor behind each tendon: the motor turns it, and it pulls the joints by a spring."""
    mj, A = mujoco(), hand_transmission(spec.motors.transmission, len(hand.actuators) // 3)
    servo, tendon_nm_rad = servo_stiffness_nm_rad(spec), tendon_stiffness_nmm_rad(spec) * NM_PER_NMM
    shaft = servo_of(catalogue.motor(spec.motors.type))
    for motor in list(hand.actuators):
        tendon = hand.tendon(motor.name)
        rotor = hand.worldbody.add_body(name=f"{motor.name} rotor", pos=[0.0, 0.0, -1.0])
        rotor.mass, rotor.inertia, rotor.explicitinertial = 1e-6, [1e-12] * 3, True
        axle = rotor.add_joint(name=f"{motor.name} rotor", type=mj.mjtJoint.mjJNT_HINGE)
        axle.axis, axle.armature = [0.0, 0.0, 1.0], shaft.inertia_kgm2
        tendon.armature = 0.0
        tendon.wrap_joint(axle.name, -1.0)
        tendon.stiffness, tendon.springlength = [tendon_nm_rad, 0.0, 0.0], [0.0, 0.0]
        tendon.damping = [tendon_nm_rad * TENDON_LOSS_S, 0.0, 0.0]
        motor.trntype, motor.target = mj.mjtTrn.mjTRN_JOINT, axle.name
        motor.ctrllimited = False
        motor.gainprm[0], motor.biasprm[1], motor.biasprm[2] = servo, -servo, -shaft.damping_nms_rad
    return A


def _tool(hand: Any, trajectory: Trajectory, trial: Trial) -> None:
    """The free tool, what holds it until the hand does, and the force at its tip."""
    mj, tool = mujoco(), trajectory.tool
    body = hand.worldbody.add_body(name=TOOL)
    body.pos, body.quat = tool.pose_palm[0, :3], tool.pose_palm[0, 3:]
    body.add_freejoint(name=TOOL)
    length = tool.tip_m - tool.back_m
    along, across = tool_inertia(trial.tool_mass_kg, tool.radius_m, length)
    body.mass, body.inertia = trial.tool_mass_kg, [along, across, across]
    body.ipos, body.explicitinertial = [(tool.tip_m + tool.back_m) / 2, 0.0, 0.0], True
    stick = body.add_geom(name=TOOL, type=mj.mjtGeom.mjGEOM_CAPSULE, contype=0, conaffinity=0)
    stick.fromto = [tool.back_m, 0.0, 0.0, tool.tip_m, 0.0, 0.0]
    stick.size = [tool.radius_m, 0.0, 0.0]
    body.add_site(name=TIP, pos=[tool.tip_m, 0.0, 0.0])
    push = hand.add_actuator(name=TIP, target=TIP, trntype=mj.mjtTrn.mjTRN_SITE)
    push.set_to_motor()
    held = hand.add_equality(name=GIVER, type=mj.mjtEq.mjEQ_WELD, name1="world", name2=TOOL)
    held.objtype = mj.mjtObj.mjOBJ_BODY
    held.data = [0.0, 0.0, 0.0, *tool.pose_palm[0], 1.0, 0.0]


def _soften(model: Any, stiffness_n_m: float) -> None:
    """Give the pairs with the tool the skin's stiffness.

    With constant impedance d, a contact that is pressed in by r pushes with s r / ((1 - d) w), where
    s is the stiffness of `solref` and w the sum of both bodies' inverse masses. docs/physics.md.
    """
    weights = model.body_invweight0[:, 0]
    for pair in range(model.npair):
        geoms = model.pair_geom1[pair], model.pair_geom2[pair]
        weight = sum(weights[model.geom_bodyid[geom]] for geom in geoms)
        scaled = stiffness_n_m * (1 - IMPEDANCE) * weight
        model.pair_solref[pair] = [-scaled, -2.0 * np.sqrt(scaled)]
        model.pair_solimp[pair] = [IMPEDANCE, IMPEDANCE, 1.0, 0.5, 2.0]


def _scene(model: Any, trajectory: Trajectory, A: Array) -> Scene:
    def addresses(names: list[str]) -> Array:
        return np.array([model.joint(name).qposadr[0] for name in names])

    motors = [model.actuator(i).name for i in range(len(A))]
    return Scene(
        model=model,
        joints=addresses(list(trajectory.joint_names)),
        rotors=addresses([f"{motor} rotor" for motor in motors]),
        tool=int(model.joint(TOOL).qposadr[0]),
        tool_body=int(model.body(TOOL).id),
        contacts=tuple(_geom(model, contact) for contact in trajectory.contacts),
        A=A,
    )


def _geom(model: Any, contact: ContactLink) -> int:
    return int(model.geom(f"{contact.finger}_{contact.link}").id)
