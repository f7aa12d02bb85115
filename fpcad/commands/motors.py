"""Verbs for single motors and joints: find, number, home, calibrate, tighten, jog, hold."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fpcad.commands.options import BuildFolder, Design, spec_file
from fpcad.commands.wire import CalibrationFile, DriverName, Port
from fpcad.spec import load_spec

verbs = typer.Typer()
numbering = typer.Typer(help="Ids of the servos on a bus.", no_args_is_help=True)
verbs.add_typer(numbering, name="motors")


def _bench(name: str, build: Path, driver: str, port: str | None, calibration: Path | None):
    from fpcad.commands import drive
    from fpcad.commands.measuring import Measuring
    from fpcad.run.hand_files import read_hand

    design = spec_file(name)
    spec = load_spec(design)
    hand = read_hand(spec, build / spec.name)
    drive.known_driver(driver)
    kept = calibration or drive.calibration_of(design, hand, driver, port)
    return Measuring(hand, driver, port, kept)


@verbs.command()
def ports() -> None:
    """List the serial ports of this machine, and what is on them."""
    from fpcad.commands.numbering import print_ports

    print_ports()


@verbs.command()
def home(
    name: Design,
    driver: DriverName = "fw",
    port: Port = None,
    build: BuildFolder = Path("build"),
    calibration: CalibrationFile = None,
) -> None:
    """Find the motors' zeros: each joint is led to both of its ends, with little force.

    Keep the fingers free, and take the tool out. Ctrl-C stops.
    """
    _bench(name, build, driver, port, calibration).home()


@verbs.command()
def calibrate(
    name: Design,
    driver: DriverName = "fw",
    port: Port = None,
    build: BuildFolder = Path("build"),
    calibration: CalibrationFile = None,
    yes: Annotated[
        bool, typer.Option("--yes", help="Fingers are known to bend the right way; do not ask.")
    ] = False,
) -> None:
    """Home, make sure that fingers bend the right way, and measure how soft the tendons are."""
    _bench(name, build, driver, port, calibration).calibrate(yes)


@verbs.command()
def tension(
    name: Design,
    motor: Annotated[str | None, typer.Option(help="One motor, as thumb_m1; else all.")] = None,
    driver: DriverName = "fw",
    port: Port = None,
    build: BuildFolder = Path("build"),
    calibration: CalibrationFile = None,
    yes: Annotated[bool, typer.Option("--yes", help="Fingers are held; do not ask.")] = False,
) -> None:
    """Measure the slack of the tendons, one motor after the other, while you hold its finger still."""
    _bench(name, build, driver, port, calibration).tension(motor, yes)


@verbs.command()
def jog(
    name: Design,
    joint: Annotated[str, typer.Option(help="Joint to move, as index_ip_flex.")],
    to_deg: Annotated[float | None, typer.Option("--to", help="Angle to go to [deg].")] = None,
    by_deg: Annotated[float | None, typer.Option("--by", help="Angle to turn by [deg].")] = None,
    driver: DriverName = "fw",
    port: Port = None,
    build: BuildFolder = Path("build"),
    calibration: CalibrationFile = None,
    clear: Annotated[bool, typer.Option("--clear", help="Unlatch a held controller.")] = False,
) -> None:
    """Move one joint slowly, the others stay. Ctrl-C holds, twice turns the torque off."""
    if (to_deg is None) == (by_deg is None):
        raise typer.BadParameter("say either --to or --by")
    _bench(name, build, driver, port, calibration).jog(joint, to_deg, by_deg, clear)


@verbs.command()
def hold(
    name: Design,
    driver: DriverName = "fw",
    port: Port = None,
    build: BuildFolder = Path("build"),
    calibration: CalibrationFile = None,
    let_go: Annotated[bool, typer.Option("--let-go", help="Turn the torque off instead.")] = False,
) -> None:
    """Let the hand hold where it is, or let go."""
    _bench(name, build, driver, port, calibration).hold(let_go)


@numbering.command("list")
def list_servos(
    name: Design,
    driver: DriverName = "feetech",
    port: Port = None,
    build: BuildFolder = Path("build"),
) -> None:
    """List the servos that answer, and the motors that the design wants at their ids."""
    from fpcad.commands.numbering import list_ids

    list_ids(_bench(name, build, driver, port, None).hand, driver, port)


@numbering.command("assign")
def assign(
    name: Design,
    motor: Annotated[str, typer.Option(help="Motor that the servo becomes, as thumb_m1.")],
    driver: DriverName = "feetech",
    port: Port = None,
    build: BuildFolder = Path("build"),
    old: Annotated[
        int | None, typer.Option("--from", help="Its present id; else the only one on the bus.")
    ] = None,
) -> None:
    """Give a servo the id that the design has for a motor. Connect it alone, or say its present id."""
    from fpcad.commands import numbering as ids

    ids.assign(_bench(name, build, driver, port, None).hand, driver, port, motor, old)
