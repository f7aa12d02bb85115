"""A build's contacts checked once more, by MuJoCo's geometry in `hand/mjcf/scene.xml`.

Nothing of fpcad is imported, and nothing of the first check's geometry is used.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports]
from numpy.typing import NDArray

from tests.make.build_check import TOUCH_M, BuildCheck, Tool, Trial
from tests.make.description.engine import mujoco

Array = NDArray[np.float64]

FAR_M = 0.05
"""Distance beyond which MuJoCo need not be exact."""


class Scene:
    """Hand and tool as MuJoCo has them."""

    def __init__(self, file: Path) -> None:
        self.model = mujoco.MjModel.from_xml_path(str(file))
        self.data = mujoco.MjData(self.model)
        self.tool = self.model.geom("tool").id
        self.place_of_tool = self.model.joint("tool").qposadr[0]
        touchable = [i for i in range(self.model.ngeom) if self.model.geom_contype[i]]
        self.shapes = {i: self._link(i) for i in touchable if i != self.tool}

    def columns(self, names: list[str]) -> list[int]:
        """Where each named joint stands in the model's position vector."""
        return [self.model.joint(name).qposadr[0] for name in names]

    def clearances(self, position: Array) -> dict[str, float]:
        """Least distance [m] of each link to the tool; negative where they penetrate."""
        self.data.qpos[:] = position
        mujoco.mj_kinematics(self.model, self.data)
        least: dict[str, float] = {}
        for shape, link in self.shapes.items():
            args = self.model, self.data, shape, self.tool, FAR_M, np.zeros(6)
            least[link] = min(least.get(link, FAR_M), mujoco.mj_geomDistance(*args))
        return least

    def _link(self, shape: int) -> str:
        return self.model.body(self.model.geom_bodyid[shape]).name


class SceneTrial(Trial):
    """A trajectory's contact check whose distances MuJoCo measures."""

    def __init__(self, name: str, scene: Scene, document: dict[str, Any]) -> None:
        super().__init__(name, scene, document)  # pyright: ignore[reportArgumentType]
        self.scene = scene

    def check_instant(self, joints: Array, tool: Tool, where: str, time: float) -> None:
        at, turn = self.scene.place_of_tool, pin.Quaternion(tool.pose.rotation)
        position = joints.copy()
        position[at : at + 7] = *tool.pose.translation, turn.w, turn.x, turn.y, turn.z
        for link, clearance in self.scene.clearances(position).items():
            if link in self.contacts:
                self.worst(f"gap at {where} [mm]", 1e3 * abs(clearance))
                if abs(clearance) > TOUCH_M:
                    self.fault(f"{link} is {1e3 * clearance:.4f} mm off the tool at {time:.3f} s")
            elif clearance < -TOUCH_M:
                self.fault(f"{link} is {-1e3 * clearance:.4f} mm inside the tool at {time:.3f} s")


def check_scene(folder: Path) -> BuildCheck:
    """Check the contacts of all trajectories of a build folder, at knots and between them."""
    check, scene = BuildCheck(), Scene(folder / "hand" / "mjcf" / "scene.xml")
    for file in sorted(folder.glob("trajectories/*.json")):
        trial = SceneTrial(file.stem, scene, json.loads(file.read_text(encoding="utf-8")))
        trial.check_contact()
        check.violations += trial.violations
        check.figures[file.stem] = trial.figures
    return check
