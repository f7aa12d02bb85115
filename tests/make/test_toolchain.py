"""A missing system library is told in one line that names the package to install."""

from __future__ import annotations

import pytest

from fpcad.errors import MakeError, ToolchainError
from fpcad.make import toolchain
from fpcad.make.toolchain import modelling


def without(monkeypatch: pytest.MonkeyPatch, *missing: str) -> None:
    monkeypatch.setattr(toolchain, "_loads", lambda library: library not in missing)


def test_cadquery_names_the_one_library_that_is_missing(monkeypatch):
    without(monkeypatch, "libGL.so.1")
    with pytest.raises(ToolchainError) as raised:
        toolchain.cadquery()
    assert str(raised.value) == (
        "cadquery needs the system library libGL.so.1: install it with `apt-get install libgl1`"
    )


def test_cadquery_names_all_libraries_that_are_missing(monkeypatch):
    without(monkeypatch, "libGL.so.1", "libX11.so.6")
    with pytest.raises(ToolchainError, match="install them with `apt-get install libgl1 libx11-6`"):
        toolchain.cadquery()


def test_drawing_needs_either_library(monkeypatch):
    without(monkeypatch, "libEGL.so.1", "libOSMesa.so.8")
    with pytest.raises(ToolchainError, match=r"libEGL\.so\.1 or libOSMesa\.so\.8.*libegl1`"):
        toolchain.pyvista()


def test_a_library_that_does_not_exist_does_not_load():
    assert not toolchain._loads("libdoes-not-exist.so.0")


def test_a_failure_of_the_cad_kernel_names_the_part():
    from OCP.Standard import (
        Standard_Failure,  # pyright: ignore[reportAttributeAccessIssue] - no stubs in the wheel
    )

    told = "part palm: the CAD kernel cannot model it"
    with pytest.raises(MakeError, match=told), modelling("palm"):
        raise Standard_Failure("curves do not join")
