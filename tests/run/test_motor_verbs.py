"""The verbs for motors, as people type them, on a hand whose files are written here."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from fpcad.cli import app
from fpcad.run import stream
from fpcad.run.calibration import (
    Calibration,
    read_calibration,
    transmission_hash,
    write_calibration,
)
from fpcad.run.errors import CalibrationError, LimitsError, ServoMismatch
from fpcad.run.hand_files import read_hand
from fpcad.run.sim.spawn import firmware_process
from fpcad.spec import load_spec
from tests.firmware.core import made
from tests.run.drivers.rigs import GEARS, MOTORS, mounting, servo_bench
from tests.run.fixtures import NAMES, hand_limits, swing, write_trajectory

CLAY = Path(__file__).parents[2] / "designs" / "clay.yaml"


def urdf_text(names=NAMES):
    limits = hand_limits()
    rows = zip(names, limits.lower_rad, limits.upper_rad, strict=True)
    joints = "".join(
        f'<joint name="{name}" type="revolute"><parent link="palm"/><child link="{name}_link"/>'
        f'<axis xyz="0 1 0"/><limit lower="{low!r}" upper="{high!r}" velocity="1.57"/></joint>'
        for name, low, high in ((n, float(a), float(b)) for n, a, b in rows)
    )
    links = "".join(f'<link name="{name}_link"/>' for name in names)
    return f'<robot name="clay"><link name="palm"/>{links}{joints}</robot>'


def transmission_text():
    plain = {
        "motor_type": "STS3215-12V",
        "motors": list(MOTORS),
        "joints": list(NAMES),
        "matrix": GEARS.matrix.tolist(),
        "offset_rad": GEARS.offset_rad.tolist(),
    }
    lines = [f"{key}: {json.dumps(value)}" for key, value in plain.items()]
    return "\n".join(["# written by a test", *lines, ""]).replace('"STS3215-12V"', "STS3215-12V")


@pytest.fixture
def design(tmp_path):
    """A design with a build of it that has all that motors need."""
    file = tmp_path / "designs" / "clay.yaml"
    file.parent.mkdir()
    file.write_text(CLAY.read_text())
    folder = tmp_path / "build" / "clay"
    (folder / "hand" / "urdf").mkdir(parents=True)
    (folder / "hand" / "urdf" / "clay.urdf").write_text(urdf_text())
    (folder / "hand" / "transmission.yaml").write_text(transmission_text())
    (folder / "trajectories").mkdir()
    write_trajectory(folder / "trajectories", swing(1.0, amplitude=0.03))
    return file


@pytest.fixture
def fpcad(design):
    """Run a verb on the hand: what it printed; errors as they are."""

    def run(verb, *arguments):
        words = [*verb.split(), str(design), "--build", str(design.parents[1] / "build")]
        result = CliRunner().invoke(app, [*words, *map(str, arguments)])
        if result.exception is not None and not isinstance(result.exception, SystemExit):
            raise result.exception
        assert result.exit_code == 0, result.output
        return result.output

    return run


def the_hand(design):
    spec = load_spec(design)
    return read_hand(spec, design.parents[1] / "build" / "clay")


def measured(design, mounted, driver="feetech"):
    """Write the calibration of a hand whose motors sit as `mounted`; where it lies."""
    hand = the_hand(design)
    limits = hand.limits
    found = Calibration(
        driver,
        transmission_hash(limits.configuration),
        hand.motors,
        limits.names,
        mounted.zero_rad,
        mounted.sign,
        np.full(12, 12.0),
        limits.lower_rad,
        limits.upper_rad,
    )
    file = design.parent / "calibration" / "clay.yaml"
    write_calibration(file, found, limits)
    return file, found


def test_simulated_motors_are_calibrated_jogged_and_run(fpcad):
    quick = ("--driver", "sim", "--port", "sim:100")
    said = fpcad("calibrate", *quick, "--yes")
    assert "zeros of 12 motors written to" in said and "ring_m3: 12.0 N m/rad" in said
    assert "slack 0.0 deg" in fpcad("tension", *quick, "--motor", "thumb_m1", "--yes")
    assert "led to 20.0 deg" in fpcad("jog", *quick, "--joint", "index_ip_flex", "--to", 20)
    said = fpcad("run-trajectory", *quick, "--pose", "swing")
    assert "12 simulated, firmware 1: READY" in said


def test_servos_without_calibration_are_not_moved(fpcad):
    with (
        servo_bench("feetech") as bench,
        pytest.raises(
            CalibrationError, match=r"there is none yet.*`fpcad calibrate`.*did not move"
        ),
    ):
        fpcad("run-trajectory", "--pose", "swing", "--driver", "feetech", "--port", bench.port)


def test_calibrated_servos_are_jogged_run_held_and_let_go(fpcad, design):
    measured(design, mounting())
    with servo_bench("feetech") as bench:
        port = ("--driver", "feetech", "--port", bench.port)
        fpcad("run-trajectory", *port, "--pose", "swing")
        assert list((design.parents[1] / "build" / "clay" / "runs").glob("swing-*.parquet"))
        before = bench.hand.joint_rad
        fpcad("jog", *port, "--joint", "thumb_ip_flex", "--by", -5)
        bench.pass_time()
        moved = np.degrees(bench.hand.joint_rad - before)
        assert moved[2] == pytest.approx(-5, abs=0.5) and np.abs(np.delete(moved, 2)).max() < 0.5
        with pytest.raises(LimitsError, match="is beyond its limits"):
            fpcad("jog", *port, "--joint", "thumb_ip_flex", "--to", 200)
        assert "keep their last goal" in " ".join(fpcad("hold", *port).split())
        assert all(bench.torque_on(n) for n in range(1, 13))
        fpcad("hold", *port, "--let-go")
        assert not any(bench.torque_on(n) for n in range(1, 13))


def test_servos_are_listed_and_numbered(fpcad):
    with servo_bench("feetech") as bench:
        bench.renumber(1, 25)
        port = ("--driver", "feetech", "--port", bench.port)
        said = fpcad("motors list", *port)
        assert "no answer" in said and "thumb_m1" in said and "STS3215" in said
        with pytest.raises(ServoMismatch, match="connect one servo alone"):
            fpcad("motors assign", *port, "--motor", "thumb_m1")
        assert "has id 1" in fpcad("motors assign", *port, "--motor", "thumb_m1", "--from", 25)
        assert 1 in bench.memory and 25 not in bench.memory


@pytest.mark.real_time
def test_the_firmware_is_calibrated_and_what_it_found_is_kept(fpcad, design, monkeypatch):
    made("host")
    monkeypatch.setattr(stream, "START_LEAD_S", 0.06)  # a hurried controller needs less
    hand = the_hand(design)
    zero = np.linspace(-0.3, 0.3, 12)
    unhomed = {"homed": False, "zero_error_rad": zero, "homing_speed_rad_s": 2.0}
    start = np.tile([0.3, 0.0, 0.4], 4)
    with firmware_process(hand.limits, start, clock_rate=20.0, **unhomed) as device:
        said = fpcad("calibrate", "--port", device.port, "--yes")
    assert "zeros of 12 motors written to" in said
    kept = read_calibration(
        design.parent / "calibration" / "clay.yaml", hand.motors, hand.limits, "fw"
    )
    assert np.abs(np.abs(kept.zero_rad) - np.abs(zero)).max() < np.radians(1.5)
    # Tendons of 30 N m/rad and the end stops' own softness; see test_preload_pull.py.
    assert ((kept.stiffness_nm_rad > 18) & (kept.stiffness_nm_rad < 31)).all()


@pytest.mark.real_time
def test_slack_is_told_behind_the_firmware_too(fpcad, monkeypatch):
    made("host")
    monkeypatch.setattr(stream, "START_LEAD_S", 0.06)
    said = fpcad("tension", "--port", "fw:20", "--motor", "thumb_m1", "--yes")
    assert "thumb_m1: slack 0." in said and said.strip().endswith("good")


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (lambda text: text[:200], "cannot be read"),
        (lambda text: text.replace("{zero_rad: ", "{zero_rad: 1e9, was: ", 1), "implausible"),
        (lambda text: text.replace("thumb_m1", "thumb_m9"), "cannot be read"),
        (lambda text: text.replace("driver: feetech", "driver: dynamixel"), "with the driver"),
        (lambda text: text.replace("sha256: ", "sha256: 0"), "another transmission"),
    ],
)
def test_a_calibration_that_cannot_be_is_refused(design, damage, words):
    file, _ = measured(design, mounting())
    file.write_text(damage(file.read_text().replace("sha256: \n  ", "sha256: ")))
    hand = the_hand(design)
    with pytest.raises(CalibrationError, match=words):
        read_calibration(file, hand.motors, hand.limits, "feetech")


def test_an_implausible_range_is_not_written(design):
    file, found = measured(design, mounting())
    before = file.read_bytes()
    wrong = replace(found, upper_rad=found.upper_rad * 1.2)
    with pytest.raises(CalibrationError, match=r"thumb_mcp_flex: turns .* the design has"):
        write_calibration(file, wrong, the_hand(design).limits)
    assert file.read_bytes() == before
