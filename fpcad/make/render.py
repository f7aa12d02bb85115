"""Pictures of a hand from its build's files, drawn without a screen."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import yourdfpy
from numpy.typing import NDArray

from fpcad.make.description import BASE_LINK
from fpcad.make.toolchain import pyvista
from fpcad.store import write_whole

Array = NDArray[np.float64]

BACKGROUND = ("#ffffff", "#dfe6ec")
TOOL_COLOUR = "#b98b52"
SHARP_EDGE_DEG = 30.0
"""Facets that meet at a smaller angle are shaded as one smooth face."""


@dataclass(frozen=True)
class PicturedTool:
    """A cylinder along x of its own frame. SI units."""

    pose_palm: Array  # (4, 4) pose in `palm` [m]
    radius_m: float
    back_m: float
    tip_m: float


@dataclass(frozen=True)
class View:
    """Where the picture is taken from, in `palm`."""

    direction: tuple[float, float, float] = (0.55, -1.0, 0.30)
    """From the hand to the camera."""
    up: tuple[float, float, float] = (0.0, 0.0, 1.0)
    size: tuple[int, int] = (1280, 960)
    """Width and height [pixels]."""
    zoom: float = 1.15


def render_hand(
    urdf: Path,
    joints_rad: Mapping[str, float],
    png: Path,
    tool: PicturedTool | None = None,
    view: View = View(),
) -> Path:
    """Draw the hand of a URDF in a posture, joints by name [rad], and write it as PNG.

    Joints that are not named stand at zero. Raises :class:`fpcad.errors.ToolchainError` where the
    system lacks what drawing without a screen needs.
    """
    pv = pyvista()
    plotter = pv.Plotter(off_screen=True, window_size=list(view.size), lighting="light kit")
    try:
        plotter.set_background(BACKGROUND[0], top=BACKGROUND[1])
        _add_hand(plotter, pv, urdf, joints_rad)
        if tool is not None:
            _add_tool(plotter, pv, tool)
        _aim(plotter, view)
        plotter.enable_anti_aliasing("ssaa")
        with tempfile.TemporaryDirectory() as folder:
            shot = Path(folder) / "hand.png"
            plotter.screenshot(str(shot))
            return write_whole(png, shot.read_bytes())
    finally:
        plotter.close()


def _add_hand(plotter: Any, pv: Any, urdf: Path, joints_rad: Mapping[str, float]) -> None:
    robot = yourdfpy.URDF.load(str(urdf), load_meshes=False, build_scene_graph=True)
    robot.update_cfg({name: joints_rad.get(name, 0.0) for name in robot.actuated_joint_names})
    colours = {m.name: m.color.rgba for m in robot.robot.materials if m.color is not None}
    for name, link in robot.link_map.items():
        pose = robot.get_transform(name, BASE_LINK)
        for visual in link.visuals:
            mesh = pv.read(str(urdf.parent / visual.geometry.mesh.filename))
            at = pose if visual.origin is None else pose @ visual.origin
            rgb = [float(value) for value in colours[visual.material.name][:3]]
            _add(plotter, mesh.transform(at, inplace=False), rgb, specular=0.15)


def _add_tool(plotter: Any, pv: Any, tool: PicturedTool) -> None:
    length = tool.tip_m - tool.back_m
    centre = ((tool.tip_m + tool.back_m) / 2, 0.0, 0.0)
    stick = pv.Cylinder(
        center=centre, direction=(1.0, 0.0, 0.0), radius=tool.radius_m, height=length, resolution=96
    )
    stick = stick.triangulate().transform(tool.pose_palm, inplace=False)
    _add(plotter, stick, TOOL_COLOUR, specular=0.3)


def _add(plotter: Any, mesh: Any, colour: Any, specular: float) -> None:
    plotter.add_mesh(
        mesh,
        color=colour,
        smooth_shading=True,
        split_sharp_edges=True,
        feature_angle=SHARP_EDGE_DEG,
        ambient=0.15,
        specular=specular,
        specular_power=20,
    )


def _aim(plotter: Any, view: View) -> None:
    low, high = np.array(plotter.bounds).reshape(3, 2).T
    centre, size = (low + high) / 2, float(np.linalg.norm(high - low))
    direction = np.array(view.direction) / np.linalg.norm(view.direction)
    plotter.camera_position = [tuple(centre + 2 * size * direction), tuple(centre), view.up]
    plotter.reset_camera()
    plotter.camera.zoom(view.zoom)
