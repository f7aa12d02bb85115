import errno
import os
import pty

import pytest
import serial

from fpcad.run.errors import (
    ControllerSilent,
    LinkLost,
    PortBusy,
    PortForbidden,
    PortMissing,
    PortUnusable,
    SimulatorError,
)
from fpcad.run.port import open_port
from fpcad.run.run_trajectory import run_trajectory
from fpcad.run.sim import spawn
from tests.run.fixtures import hand_limits, write_trajectory


@pytest.fixture
def terminal():
    master, slave = pty.openpty()
    yield master, os.ttyname(slave)
    os.close(slave)
    os.close(master)


def test_a_missing_port_is_named(tmp_path):
    with pytest.raises(PortMissing, match=r"^/dev/ttyNOWHERE: no such port; .*present.*$"):
        run_trajectory(write_trajectory(tmp_path), hand_limits(), "/dev/ttyNOWHERE")


def test_a_busy_port_is_named(tmp_path, terminal):
    _, name = terminal
    with serial.Serial(name, exclusive=True), pytest.raises(PortBusy, match="another program"):
        run_trajectory(write_trajectory(tmp_path), hand_limits(), name)


def test_a_forbidden_port_comes_with_advice(monkeypatch):
    def refuse(*_args, **_kwargs):
        raise serial.SerialException(errno.EACCES, "could not open port")

    monkeypatch.setattr(serial, "Serial", refuse)
    with pytest.raises(PortForbidden, match="dialout"):
        open_port("/dev/ttyUSB0")


def test_a_file_is_no_port(tmp_path):
    file = tmp_path / "file"
    file.write_text("")
    with pytest.raises(PortUnusable, match="is no serial port"):
        open_port(str(file))


def test_a_silent_port_is_given_up(tmp_path, terminal):
    _, name = terminal
    with pytest.raises(ControllerSilent, match=r"no answer within 0\.3 s"):
        run_trajectory(write_trajectory(tmp_path), hand_limits(), name, patience_s=0.3)


def test_a_line_that_breaks_is_named():
    master, slave = pty.openpty()
    port = open_port(os.ttyname(slave))
    os.close(slave)
    os.close(master)
    with pytest.raises(LinkLost, match="the line broke"):
        port.read()
    with pytest.raises(LinkLost, match="the line broke"):
        port.write(b"\0")
    port.close()


def test_a_firmware_that_is_not_built_comes_with_advice(tmp_path, monkeypatch):
    monkeypatch.setattr(spawn, "FIRMWARE", tmp_path / "fpcad-firmware")
    with pytest.raises(SimulatorError, match="`make firmware`"):
        run_trajectory(write_trajectory(tmp_path), hand_limits(), "fw")


@pytest.mark.parametrize("port", ["sim:0", "sim:fast", "sim:1e9", "sim:nan", "fw:0"])
def test_a_simulated_port_has_a_sane_rate(tmp_path, port):
    with pytest.raises(PortMissing, match=r"(sim|fw):RATE"):
        run_trajectory(write_trajectory(tmp_path), hand_limits(), port)
