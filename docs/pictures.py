"""Render the pictures of README.md from a finished build: .venv/bin/python docs/pictures.py clay."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image
from scipy.spatial.transform import Rotation

from fpcad.make.render import PicturedTool, render_hand
from fpcad.make.trajectory_file import read_trajectory

WIDTH, HEIGHT = 640, 600


def picture(build: Path, trajectory_file: Path, png: Path) -> Path:
    """The hand of a build at one pose, with its tool."""
    trajectory = read_trajectory(trajectory_file)
    x, y, z, *quaternion = trajectory.tool.pose_palm[0]
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    pose[:3, :3] = Rotation.from_quat(quaternion, scalar_first=True).as_matrix()
    joints = dict(zip(trajectory.joint_names, trajectory.position_rad[0], strict=True))
    tool = trajectory.tool
    pictured = PicturedTool(pose, tool.radius_m, tool.back_m, tool.tip_m)
    return render_hand(build / "hand" / "urdf" / f"{build.name}.urdf", joints, png, pictured)


def main(name: str) -> None:
    """Write docs/images/NAME.png with all poses side by side."""
    build = Path("build") / name
    with tempfile.TemporaryDirectory() as folder:
        pictures = [
            Image.open(picture(build, file, Path(folder) / f"{file.stem}.png"))
            for file in sorted((build / "trajectories").glob("*.json"))
        ]
    strip = Image.new("RGB", (WIDTH * len(pictures), HEIGHT))
    for place, image in enumerate(pictures):
        scaled = image.resize((WIDTH * 5 // 4, HEIGHT))
        strip.paste(scaled.crop((WIDTH // 8, 0, WIDTH // 8 + WIDTH, HEIGHT)), (WIDTH * place, 0))
    strip.save(Path("docs") / "images" / f"{name}.png", optimize=True)


main(sys.argv[1])
