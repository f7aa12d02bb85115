"""What a trial looks like: a film, a sheet of its frames, and curves."""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from fpcad.make.toolchain import pyvista
from fpcad.make.trajectory import Trajectory
from fpcad.simulate.engine import mujoco
from fpcad.simulate.measure import tool_angles
from fpcad.simulate.roll import Record
from fpcad.simulate.scene import TOOL, Scene
from fpcad.simulate.trials import Tried
from fpcad.spec.pose import Turning
from fpcad.store import write_whole
from fpcad.units import DEG_PER_RAD

Array = NDArray[np.float64]

FRAMES = 40
FRAME_MS = 120
SHEET = (4, 2)
"""Columns and rows of the sheet."""
SIZE = (480, 400)
"""Width and height of a frame [pixels]."""
COLOURS = ("#e07a5f", "#3d85c6", "#6aa84f", "#8e7cc3")
"""Of the fingers, in their order."""
TOOL_COLOUR, PLAN_COLOUR, PALM_COLOUR = "#8a5a2b", "#9aa0a6", "#d9d2c5"
VIEW = (0.55, -1.0, -0.45)
"""From the hand to the camera, in H: from below, where the tool is."""


@dataclass(frozen=True)
class Body:
    """A capsule that moves: its actor, its geom in the model, None for the planned tool."""

    actor: Any
    geom: int | None


def film(
    scene: Scene, record: Record, trajectory: Trajectory, gif: Path, sheet: Path
) -> list[Path]:
    """Write a trial's film (GIF) and a sheet of its frames (PNG); the planned tool is grey.

    Raises :class:`fpcad.errors.ToolchainError` where the system cannot draw without a screen.
    """
    ticks = np.linspace(0, len(record.time_s) - 1, FRAMES).astype(int)
    frames = list(_frames(scene, record, trajectory, ticks))
    chosen = [frames[i] for i in np.linspace(0, FRAMES - 1, SHEET[0] * SHEET[1]).astype(int)]
    stream = io.BytesIO()
    frames[0].save(
        stream, "GIF", save_all=True, append_images=frames[1:], duration=FRAME_MS, loop=0
    )
    return [write_whole(gif, stream.getvalue()), write_whole(sheet, _png(_tiled(chosen)))]


def curves(tried: Sequence[Tried], trajectory: Trajectory, turning: Turning, png: Path) -> Path:
    """Write the tool's angle over time for each trial, and the first one's contact forces (PNG).

    A cross marks where a tool tips; what it turns after that is faint.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 7), layout="constrained")
    angle, forces = figure.subplots(2, 1, sharex=True)
    first = tried[0].record
    planned = first.planned_angle_rad * DEG_PER_RAD
    angle.plot(first.time_s, planned, "k--", lw=1, label="planned")
    for one in tried:
        turned = tool_angles(one.record, trajectory, turning)[0] * DEG_PER_RAD
        time, tipped = one.record.time_s, one.outcome.tipped_at_s
        led = time <= (np.inf if tipped is None else tipped)
        (line,) = angle.plot(time[led], turned[led], lw=1, label=one.name)
        angle.plot(time[~led], turned[~led], lw=1, alpha=0.3, color=line.get_color())
        if tipped is not None:
            angle.plot(time[led][-1], turned[led][-1], "x", color=line.get_color())
    angle.set_ylabel("turn of the tool [deg]")
    margin = 0.1 * (np.ptp(planned) + 1.0)
    angle.set_ylim(planned.min() - margin, planned.max() + margin)
    angle.legend(fontsize=8)
    for index, contact in enumerate(trajectory.contacts):
        forces.plot(first.time_s, first.normal_n[:, index], lw=1, label=f"{contact.finger}")
    forces.set(xlabel="time [s]", ylabel=f"normal force, {tried[0].name} [N]")
    forces.legend(fontsize=8)
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=110, metadata={"Software": None})
    return write_whole(png, stream.getvalue())


def _frames(
    scene: Scene, record: Record, trajectory: Trajectory, ticks: Array
) -> Iterator[Image.Image]:
    mj, pv = mujoco(), pyvista()
    data = mj.MjData(scene.model)
    plotter = pv.Plotter(off_screen=True, window_size=list(SIZE), lighting="light kit")
    try:
        plotter.set_background("white")
        bodies = _bodies(plotter, pv, scene, trajectory)
        for number, tick in enumerate(ticks):
            data.qpos[scene.joints] = record.joints_rad[tick]
            data.qpos[scene.tool : scene.tool + 7] = record.tool_pose[tick]
            mj.mj_kinematics(scene.model, data)
            for body in bodies:
                body.actor.user_matrix = _place(body, data, record, trajectory, int(tick))
            if number == 0:
                _aim(plotter, record)
            plotter.render()
            image = Image.fromarray(plotter.screenshot(return_img=True))
            yield _labelled(image, record, int(tick))
    finally:
        plotter.close()


def _bodies(plotter: Any, pv: Any, scene: Scene, trajectory: Trajectory) -> list[Body]:
    mj, model = mujoco(), scene.model
    fingers = list(dict.fromkeys(name.split("_")[0] for name in trajectory.joint_names))
    bodies = []
    for geom in range(model.ngeom):
        name, radius, half = model.geom(geom).name, *model.geom_size[geom, :2]
        capsule = model.geom_type[geom] == mj.mjtGeom.mjGEOM_CAPSULE
        mesh = _capsule(pv, float(radius), float(half) if capsule else 0.0)
        finger = name.split("_")[0]
        colour = COLOURS[fingers.index(finger) % len(COLOURS)] if finger in fingers else PALM_COLOUR
        if name == TOOL:
            bodies.append(Body(plotter.add_mesh(mesh, color=PLAN_COLOUR, opacity=0.35), None))
            colour = TOOL_COLOUR
        bodies.append(Body(plotter.add_mesh(mesh, color=colour, smooth_shading=True), geom))
    return bodies


def _capsule(pv: Any, radius: float, half: float) -> Any:
    """A capsule along z about the origin."""
    ball = pv.Sphere(radius=radius, theta_resolution=32, phi_resolution=16)
    if half == 0.0:
        return ball
    stick = pv.Cylinder(direction=(0, 0, 1), radius=radius, height=2 * half, resolution=32)
    ends = [ball.translate((0, 0, z), inplace=False) for z in (-half, half)]
    return pv.merge([stick.triangulate(), *ends]).extract_surface(algorithm="dataset_surface")


def _place(body: Body, data: Any, record: Record, trajectory: Trajectory, tick: int) -> Array:
    pose = np.eye(4)
    if body.geom is not None:
        pose[:3, :3], pose[:3, 3] = (
            data.geom_xmat[body.geom].reshape(3, 3),
            data.geom_xpos[body.geom],
        )
        return pose
    from scipy.spatial.transform import Rotation

    tool = trajectory.tool
    nearest = int(np.argmin(np.abs(trajectory.time_s - max(record.time_s[tick], 0.0))))
    orientation = Rotation.from_quat(tool.pose_palm[nearest, 3:], scalar_first=True)
    along = orientation * Rotation.from_euler("y", 90, degrees=True)  # capsules lie along z
    middle = orientation.apply([(tool.back_m + tool.tip_m) / 2, 0.0, 0.0])
    pose[:3, :3], pose[:3, 3] = along.as_matrix(), tool.pose_palm[nearest, :3] + middle
    return pose


def _aim(plotter: Any, record: Record) -> None:
    centre = 0.7 * record.tool_pose[0, :3]
    away = np.array(VIEW) / np.linalg.norm(VIEW)
    plotter.camera_position = [tuple(centre + 0.55 * away), tuple(centre), (0.0, 0.0, 1.0)]
    plotter.camera.view_angle = 25.0


def _labelled(image: Image.Image, record: Record, tick: int) -> Image.Image:
    planned = record.planned_angle_rad[tick] * DEG_PER_RAD
    text = f"{record.time_s[tick]:.1f} s, planned {planned:.0f} deg"
    ImageDraw.Draw(image).text((8, 6), text, fill="black")
    return image


def _tiled(frames: Sequence[Image.Image]) -> Image.Image:
    sheet = Image.new("RGB", (SIZE[0] * SHEET[0], SIZE[1] * SHEET[1]), "white")
    for number, frame in enumerate(frames):
        row, column = divmod(number, SHEET[0])
        sheet.paste(frame, (column * SIZE[0], row * SIZE[1]))
    return sheet


def _png(image: Image.Image) -> bytes:
    stream = io.BytesIO()
    image.save(stream, "PNG")
    return stream.getvalue()
