"""Pictures of parts and of fingers put together, taken apart and cut open, drawn without a screen."""

from __future__ import annotations

import io
import tempfile
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import trimesh
from numpy.typing import NDArray
from PIL import Image, ImageChops

from fpcad.make.documents.stamp import Stamp
from fpcad.make.gates.bodies import link_poses
from fpcad.make.mesh import manifold_of
from fpcad.make.parts.assembly import Assembly, BoughtItem
from fpcad.make.parts.part import STILL_LINKS
from fpcad.make.toolchain import pyvista
from fpcad.model.geometry import HandGeometry

Array = NDArray[np.float64]
Piece = tuple[trimesh.Trimesh, str]
"""A mesh [mm] and its colour."""

COLOURS = {"endoskeleton": "#d8d2bf", "skin": "#e07350", "metal": "#9ea3ab"}
BOUGHT_COLOUR = "#8a97a6"
SIZE = (1400, 900)
GAP_MM = 12.0
MARGIN = 20
CHAIN = ("mcp", "proximal", "distal")


def finger_pieces(assembly: Assembly, geometry: HandGeometry, apart: bool) -> list[Piece]:
    """The straight first finger in its root's frame; taken apart, its pieces stand one behind another."""
    pieces, start = [], 0.0
    for item in sorted(
        (i for i in (*assembly.parts, *assembly.bought) if i.link in CHAIN),
        key=lambda i: (CHAIN.index(i.link), isinstance(i, BoughtItem)),
    ):
        for place in item.places:
            mesh = item.mesh.copy().apply_transform(_along(geometry, item.link) @ place)
            if apart:
                mesh.apply_translation((start - mesh.bounds[0, 0], 0, 0))
                start = float(mesh.bounds[1, 0]) + GAP_MM
            pieces.append((mesh, piece_colour(item)))
    return pieces


def hand_pieces(assembly: Assembly, geometry: HandGeometry, joints: Array) -> list[Piece]:
    """The whole hand in H with its joints (n_fingers, 3) [rad]."""
    pieces = []
    for item in (*assembly.parts, *assembly.bought):
        poses = [np.eye(4)]
        if item.link not in STILL_LINKS:
            poses = [
                link_poses(geometry, finger, item.link, joints[None, i])[0]
                for i, finger in enumerate(geometry.fingers)
            ]
        for pose in poses:
            for place in item.places:
                mesh = item.mesh.copy().apply_transform(pose @ place)
                pieces.append((mesh, piece_colour(item)))
    return pieces


def cut_open(pieces: Iterable[Piece]) -> list[Piece]:
    """What lies at y >= 0 of each piece."""
    halves = []
    for mesh, colour in pieces:
        raw = manifold_of(mesh).trim_by_plane((0.0, 1.0, 0.0), 0.0).to_mesh64()
        if len(raw.tri_verts):
            half = trimesh.Trimesh(raw.vert_properties[:, :3], raw.tri_verts, process=False)
            halves.append((half, colour))
    return halves


def draw(
    pieces: Iterable[Piece], png: Path, direction: tuple[float, float, float], stamp: Stamp
) -> Path:
    """Draw pieces as seen from a direction, z up, and write them as PNG with the stamp.

    Raises :class:`fpcad.errors.ToolchainError` where the system lacks what drawing needs.
    """
    pv = pyvista()
    plotter = pv.Plotter(off_screen=True, window_size=list(SIZE), lighting="light kit")
    try:
        plotter.set_background("white")
        for colour, mesh in _by_colour(pieces).items():
            shown = pv.wrap(mesh)
            plotter.add_mesh(
                shown, color=colour, smooth_shading=True, split_sharp_edges=True, ambient=0.15
            )
        low, high = np.array(plotter.bounds).reshape(3, 2).T
        centre, size = (low + high) / 2, float(np.linalg.norm(high - low))
        towards = np.array(direction) / np.linalg.norm(direction)
        plotter.camera_position = [tuple(centre + 2 * size * towards), tuple(centre), (0, 0, 1)]
        plotter.reset_camera()
        plotter.enable_parallel_projection()
        plotter.camera.zoom(1.1)
        plotter.enable_anti_aliasing("ssaa")
        with tempfile.TemporaryDirectory() as folder:
            shot = Path(folder) / "shot.png"
            plotter.screenshot(str(shot))
            return stamp.write(png, _trimmed(shot))
    finally:
        plotter.close()


def _by_colour(pieces: Iterable[Piece]) -> dict[str, trimesh.parent.Geometry]:
    """All pieces of a colour as one mesh: each mesh that is shown costs time, however small."""
    found: dict[str, list[trimesh.Trimesh]] = {}
    for mesh, colour in pieces:
        found.setdefault(colour, []).append(mesh)
    return {colour: trimesh.util.concatenate(meshes) for colour, meshes in found.items()}


def _trimmed(shot: Path) -> bytes:
    """A PNG without the white around what it shows, but for a margin."""
    image = Image.open(shot).convert("RGB")
    box = ImageChops.difference(image, Image.new("RGB", image.size, "white")).getbbox()
    if box is not None:
        left, top, right, bottom = box
        wide, high = image.size
        low = max(left - MARGIN, 0), max(top - MARGIN, 0)
        image = image.crop((*low, min(right + MARGIN, wide), min(bottom + MARGIN, high)))
    stream = io.BytesIO()
    image.save(stream, "PNG")
    return stream.getvalue()


def _along(geometry: HandGeometry, link: str) -> Array:
    pose = np.eye(4)
    if link == "distal":
        pose[0, 3] = geometry.proximal_length_mm
    return pose


def piece_colour(item: object) -> str:
    """The colour of what is bought, or of the material."""
    return BOUGHT_COLOUR if isinstance(item, BoughtItem) else COLOURS[getattr(item, "material", "")]
