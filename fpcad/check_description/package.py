"""The files of a description package: where its robots, meshes and tables are."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML, YAMLError

from fpcad.check_description.urdf import UnreadableError, Urdf, read_urdf
from fpcad.errors import StoreError, ToolchainError

TRANSMISSION = "transmission.yaml"
JOINT_LIMITS = "joint_limits.yaml"


@dataclass(frozen=True)
class Package:
    """A folder with descriptions."""

    folder: Path

    def urdfs(self) -> list[Path]:
        """Its URDFs; without any, the xacro files that stand for one."""
        found = self._files("*.urdf") or self._files("*.urdf.xacro")
        if not found:
            raise StoreError(f"{self.folder}: no *.urdf and no *.urdf.xacro in it")
        return found

    def read(self, urdf: Path) -> Urdf:
        """Read one of its URDFs; :class:`UnreadableError` where it is none."""
        text = _expanded(urdf) if urdf.suffix == ".xacro" else urdf.read_text(encoding="utf-8")
        return read_urdf(text, partial(self._mesh, urdf))

    def mjcfs(self) -> list[Path]:
        """Its MuJoCo models; files that are included by others are none of their own."""
        return [file for file in self._files("*.xml") if _is_whole_mjcf(file)]

    def tables(self, name: str) -> list[tuple[Path, Any]]:
        """Its YAML files of a name, with their content."""
        return [(file, _yaml(file)) for file in self._files(name)]

    def _files(self, pattern: str) -> list[Path]:
        return sorted(
            file
            for file in self.folder.rglob(pattern)
            if not any(part.startswith(".") for part in file.relative_to(self.folder).parts)
        )

    def _mesh(self, urdf: Path, name: str) -> Path:
        """File of a mesh: relative to the URDF, or in a package around or in this folder."""
        if not name.startswith("package://"):
            return urdf.parent / name.removeprefix("file://")
        package, _, rest = name.removeprefix("package://").partition("/")
        homes = [*urdf.resolve().parents, *self.folder.rglob(package)]
        home = next((home for home in homes if _is_package(home, package)), self.folder)
        return home / rest


def _is_package(folder: Path, name: str) -> bool:
    """Whether a folder is a ROS package, by its own name or by what its manifest says."""
    if folder.name == name and folder.is_dir():
        return True
    try:
        return ET.parse(folder / "package.xml").getroot().findtext("name") == name
    except (OSError, ET.ParseError):
        return False


def _is_whole_mjcf(file: Path) -> bool:
    try:
        root = ET.parse(file).getroot()
    except ET.ParseError:
        return False
    return root.tag == "mujoco" and root.find(".//body") is not None


def _yaml(file: Path) -> Any:
    try:
        return YAML(typ="safe").load(file.read_text(encoding="utf-8"))
    except (YAMLError, UnicodeDecodeError) as error:
        raise UnreadableError(f"{file.name} is no YAML: {error}") from error


def _expanded(file: Path) -> str:
    try:
        import xacro
    except ModuleNotFoundError as error:
        raise ToolchainError(
            f"{file} needs the Python package {error.name}: `pip install xacro`"
        ) from error
    try:
        document: Any = xacro.process_file(str(file))
    except Exception as error:  # a macro may run into anything; the file and the cause are told
        raise UnreadableError(f"{file.name} cannot be expanded: {error}") from error
    return document.toxml()
