"""Running a trial tick by tick, and what is seen of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fpcad.errors import MakeError
from fpcad.simulate.command import Commands
from fpcad.simulate.engine import mujoco
from fpcad.simulate.scene import GIVER, Scene
from fpcad.simulate.setting import CONTROL_PERIOD_S

Array = NDArray[np.float64]

LOST_M = 0.03
"""Distance of the tool from its planned place beyond which it is lost."""


@dataclass(frozen=True)
class Record:
    """A trial as it went, one row a tick from the moment when the tool is let go of; T ticks."""

    time_s: Array
    """(T,) 0 where the trajectory starts."""
    tool_pose: Array
    """(T, 7) xyz [m] and quaternion w x y z of O in `palm`."""
    joints_rad: Array
    """(T, n_u)"""
    motor_nm: Array
    """(T, n_motors)"""
    normal_n: Array
    """(T, n) normal force at each contact that is meant to be; 0 without contact."""
    tangential_n: Array
    """(T, n)"""
    slip_mm_s: Array
    """(T, n) speed at which finger and tool slide on each other."""
    planned_angle_rad: Array
    """(T,)"""
    planned_position_m: Array
    """(T, 3)"""
    seconds: float
    """What was simulated."""


def roll(scene: Scene, commands: Commands, joints_rad: Array) -> Record:
    """Run a trial from joints (n_u,) [rad] on until it ends or the tool is lost.

    A state that is no number ends it too, as a lost tool does.
    """
    mj, model = mujoco(), scene.model
    data = mj.MjData(model)
    data.qpos[scene.joints] = joints_rad
    data.qpos[scene.rotors] = scene.A @ joints_rad
    watch = _Watch(scene, data)
    steps = round(CONTROL_PERIOD_S / model.opt.timestep)
    n_motors = len(scene.A)
    for tick in range(len(commands.motors_rad)):
        if tick == commands.let_go:
            data.eq_active[model.equality(GIVER).id] = 0
        data.ctrl[:n_motors] = commands.motors_rad[tick]
        data.ctrl[n_motors] = commands.tip_force_n[tick]
        mj.mj_step(model, data, steps)
        if not np.isfinite(data.qpos).all():
            break
        if tick >= commands.let_go:
            watch.see()
            if watch.is_lost(commands.planned_position_m[tick]):
                break
    return watch.record(commands)


class _Watch:
    """Collects what is seen at each tick."""

    def __init__(self, scene: Scene, data: Any) -> None:
        self._scene, self._data, self._mj = scene, data, mujoco()
        self._rows: list[tuple[Array, ...]] = []
        self._force, self._velocity = np.zeros(6), np.zeros(6)

    def see(self) -> None:
        """Note the state after a tick."""
        scene, data = self._scene, self._data
        self._rows.append(
            (
                data.qpos[scene.tool : scene.tool + 7].copy(),
                data.qpos[scene.joints],
                data.actuator_force[: len(scene.A)].copy(),
                *self._contacts(),
            )
        )

    def is_lost(self, planned: Array) -> bool:
        """Whether the tool is far from where it should be."""
        at = self._data.qpos[self._scene.tool : self._scene.tool + 3]
        return bool(np.linalg.norm(at - planned) >= LOST_M)

    def record(self, commands: Commands) -> Record:
        """All that was seen; :class:`MakeError` where that is nothing."""
        if not self._rows:
            raise MakeError("the simulation is unstable while the fingers close: shorten its steps")
        pose, joints, motors, normal, tangential, slip = (
            np.array(column) for column in zip(*self._rows, strict=True)
        )
        ticks = commands.let_go + np.arange(len(pose))
        return Record(
            time_s=np.asarray((ticks + 1 - commands.start) * CONTROL_PERIOD_S, dtype=np.float64),
            tool_pose=pose,
            joints_rad=joints,
            motor_nm=motors,
            normal_n=normal,
            tangential_n=tangential,
            slip_mm_s=slip,
            planned_angle_rad=commands.planned_angle_rad[ticks],
            planned_position_m=commands.planned_position_m[ticks],
            seconds=float(self._data.time),
        )

    def _contacts(self) -> tuple[Array, Array, Array]:
        scene, data, mj = self._scene, self._data, self._mj
        normal, tangential, slip = (np.zeros(len(scene.contacts)) for _ in range(3))
        for index in range(data.ncon):
            contact = data.contact[index]
            geoms = contact.geom1, contact.geom2
            finger = next((g for g in geoms if g in scene.contacts), None)
            if finger is None or contact.efc_address < 0:
                continue
            which = scene.contacts.index(finger)
            mj.mj_contactForce(scene.model, data, index, self._force)
            normal[which] += self._force[0]
            tangential[which] += np.hypot(self._force[1], self._force[2])
            slip[which] = self._sliding(contact, finger)
        return normal, tangential, slip

    def _sliding(self, contact: Any, finger: int) -> float:
        """Speed [mm/s] at which the finger's material slides over the tool's at a contact."""
        scene, mj = self._scene, self._mj
        velocities = []
        for body in (scene.tool_body, scene.model.geom_bodyid[finger]):
            mj.mj_objectVelocity(
                scene.model, self._data, mj.mjtObj.mjOBJ_BODY, body, self._velocity, 0
            )
            arm = contact.pos - self._data.xpos[body]
            velocities.append(self._velocity[3:] + _cross(self._velocity[:3], arm))
        relative = velocities[1] - velocities[0]
        normal = contact.frame[:3]
        return 1000.0 * float(np.linalg.norm(relative - normal * (normal @ relative)))


def _cross(a: Array, b: Array) -> Array:
    """Product of two vectors (3,), ten times as fast as NumPy's for many."""
    (a0, a1, a2), (b0, b1, b2) = a.tolist(), b.tolist()
    return np.array([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0])
