"""The firmware's core, compiled for this machine, as a stand-in for the simulated controller."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest

from fpcad.run.firmware_setup import FirmwareSetup, setup_text
from fpcad.run.messages import MAX_JOINTS, Cause, State
from tests.run.fixtures import hand_limits, swing

FIRMWARE = Path(__file__).parents[2] / "firmware_host"
JAM, DEATH, STUCK, HEAT = "jam", "death", "stuck", "heat"


class View(ctypes.Structure):
    """`struct view` of ports/library/bench.h."""

    _fields_ = (
        ("time_us", ctypes.c_uint64),
        ("path_us", ctypes.c_int64),
        ("rate", ctypes.c_double),
        ("queued", ctypes.c_uint16),
        ("free", ctypes.c_uint16),
        ("bad_frames", ctypes.c_uint16),
        ("state", ctypes.c_uint8),
        ("cause", ctypes.c_uint8),
        ("torque_on", ctypes.c_uint8),
        ("command", ctypes.c_int32 * MAX_JOINTS),
        ("command_velocity", ctypes.c_int32 * MAX_JOINTS),
        ("preload", ctypes.c_int32 * MAX_JOINTS),
        ("measured", ctypes.c_int32 * MAX_JOINTS),
        ("position", ctypes.c_double * MAX_JOINTS),
        ("current_ma", ctypes.c_int16 * MAX_JOINTS),
    )


def made(target: str, *variables: str) -> Path:
    """The firmware folder after `make target`; skips where there is no compiler."""
    if shutil.which("gcc") is None or shutil.which("make") is None:
        pytest.skip("needs gcc and make")
    # Tests run side by side, so one of them makes and the others wait.
    command = ["flock", str(FIRMWARE / "Makefile"), "make", "-s", "-C", str(FIRMWARE), target]
    done = subprocess.run([*command, *variables], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return FIRMWARE / "build"


@lru_cache
def library() -> ctypes.CDLL:
    # An instrumented build takes the usual one's place when coverage is measured.
    built = os.environ.get("FIRMWARE_LIBRARY")
    lib = ctypes.CDLL(built or str(made("library") / "libfpcad_firmware.so"))
    lib.bench_new.restype = ctypes.c_void_p
    lib.bench_take_output.restype = ctypes.c_uint32
    for name in ("recode", "frame", "state_after", "mishap"):
        getattr(lib, f"bench_{name}").restype = ctypes.c_uint8
    return lib


class CorePlant:
    def __init__(self, core: CoreController) -> None:
        self._core = core

    @property
    def position(self) -> np.ndarray:
        return np.array(self._core.look().position[: self._core.joints])

    @property
    def torque_on(self) -> bool:
        return bool(self._core.look().torque_on)

    def jam(self, joint: int) -> None:
        self._core.mishap(JAM, joint)


class CoreFollower:
    def __init__(self, core: CoreController) -> None:
        self._core = core

    def __getattr__(self, name: str):
        return getattr(self._core.look(), name)

    @property
    def command(self) -> np.ndarray:
        return np.array(self._core.look().command[: self._core.joints]) / 1e6

    @property
    def preload(self) -> np.ndarray:
        return np.array(self._core.look().preload[: self._core.joints]) / 1e6

    def keep(self, count: int) -> None:
        self._core.call("keep_knots", ctypes.c_uint16(count))


class CoreController:
    """The same face as :class:`fpcad.run.sim.controller.Controller`."""

    def __init__(
        self, setup: FirmwareSetup, start_rad: np.ndarray, zero_error_rad: np.ndarray | None = None
    ) -> None:
        fault = ctypes.c_char_p()
        text = setup_text(setup, start_rad).encode()
        if zero_error_rad is not None:
            text += b"zero_error " + " ".join(map(repr, zero_error_rad.tolist())).encode() + b"\n"
        self._device = ctypes.c_void_p(library().bench_new(text, ctypes.byref(fault)))
        assert fault.value is None, fault.value
        self._view = View()
        self._room = ctypes.create_string_buffer(65536)
        self.joints = len(setup.limits.names)
        self.plant = CorePlant(self)
        self.follower = CoreFollower(self)

    def __del__(self) -> None:
        library().bench_delete(self._device)

    def call(self, name: str, *arguments):
        return getattr(library(), f"bench_{name}")(self._device, *arguments)

    def look(self) -> View:
        self.call("look", ctypes.byref(self._view))
        return self._view

    def receive(self, data: bytes) -> None:
        self.call("receive", data, ctypes.c_uint32(len(data)))

    def take_output(self) -> bytes:
        count = self.call("take_output", self._room, ctypes.c_uint32(65536))
        return self._room.raw[:count] if count else b""

    def tick(self) -> None:
        self.call("tick")

    def mishap(self, kind: str, number: int) -> None:
        assert self.call("mishap", kind.encode(), ctypes.c_uint8(number))

    @property
    def state(self) -> State:
        return State(self.look().state)

    @state.setter
    def state(self, value: State) -> None:
        self.call("set_state", ctypes.c_uint8(value))

    @property
    def cause(self) -> Cause:
        return Cause(self.look().cause)

    @property
    def time_us(self) -> int:
        return self.look().time_us

    @property
    def measured(self) -> np.ndarray:
        return np.array(self.look().measured[: self.joints]) / 1e6


def core_controller(**changes) -> CoreController:
    start = changes.pop("start_rad", swing().position[0])
    zero_error_rad = changes.pop("zero_error_rad", None)
    setup = FirmwareSetup(**{"limits": hand_limits(), "boot_nonce": 7, **changes})
    return CoreController(setup, start, zero_error_rad)
