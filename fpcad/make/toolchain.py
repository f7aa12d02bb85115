"""The heavy libraries, imported on first use, after a check of the system libraries they need."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType

from fpcad.errors import MakeError, ToolchainError

SystemLibrary = tuple[str, str]
"""A shared library's name and the Debian package that holds it."""

CAD_LIBRARIES: tuple[SystemLibrary, ...] = (
    ("libGL.so.1", "libgl1"),
    ("libX11.so.6", "libx11-6"),
    ("libexpat.so.1", "libexpat1"),
)
"""What the wheels of cadquery's kernel are linked to but do not bring along."""

OFFSCREEN_WINDOWS: tuple[tuple[SystemLibrary, str], ...] = (
    (("libEGL.so.1", "libegl1"), "vtkEGLRenderWindow"),
    (("libOSMesa.so.8", "libosmesa6"), "vtkOSOpenGLRenderWindow"),
)
"""What lets VTK draw without a screen, best first, and the window class that uses it."""


def cadquery() -> ModuleType:
    """The cadquery module; takes seconds and 0.5 GB the first time."""
    _require_all("cadquery", CAD_LIBRARIES)
    import cadquery

    return cadquery


@contextmanager
def modelling(part: str) -> Iterator[None]:
    """Within it, a failure of the CAD kernel is a :class:`MakeError` that names the part."""
    cadquery()
    from OCP.Standard import (
        Standard_Failure,  # pyright: ignore[reportAttributeAccessIssue] - no stubs in the wheel
    )

    try:
        yield
    except Standard_Failure as error:
        raise MakeError(f"part {part}: the CAD kernel cannot model it ({error})") from error


def pyvista() -> ModuleType:
    """The pyvista module, ready to draw without a screen."""
    window = _offscreen_window()
    os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", window)  # else VTK tries the X server first
    try:
        import pyvista
    except ModuleNotFoundError as error:
        raise ToolchainError(
            f"drawing needs the Python package {error.name}: `pip install fpcad[pictures]`"
        ) from error
    return pyvista


def _require_all(user: str, libraries: tuple[SystemLibrary, ...]) -> None:
    missing = [(library, package) for library, package in libraries if not _loads(library)]
    if missing:
        names = ", ".join(library for library, _ in missing)
        packages = " ".join(package for _, package in missing)
        noun, it = ("library", "it") if len(missing) == 1 else ("libraries", "them")
        raise ToolchainError(
            f"{user} needs the system {noun} {names}: install {it} with "
            f"`apt-get install {packages}`"
        )


def _offscreen_window() -> str:
    for (library, _), window in OFFSCREEN_WINDOWS:
        if _loads(library):
            return window
    names = " or ".join(library for (library, _), _ in OFFSCREEN_WINDOWS)
    raise ToolchainError(
        f"drawing without a screen needs the system library {names}: install it with "
        f"`apt-get install {OFFSCREEN_WINDOWS[0][0][1]}`"
    )


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True
