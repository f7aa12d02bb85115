"""Which ports and servos there are, and giving servos their ids."""

from __future__ import annotations

import difflib
from contextlib import closing

import typer
from rich.console import Console
from rich.table import Table
from serial.tools import list_ports

from fpcad.commands.console import console
from fpcad.commands.drive import needed_port
from fpcad.run.drivers.choose import SERVOS, register_bus
from fpcad.run.drivers.servos import ServoRegisterBus
from fpcad.run.errors import ServoMismatch, ServoSilent
from fpcad.run.hand_files import HandFiles

out = Console()
_SCANNED = range(1, 31)


def servos_of(hand: HandFiles, driver: str, port: str | None) -> ServoRegisterBus:
    """The servo bus of a hand, not opened yet."""
    if driver not in SERVOS:
        raise typer.BadParameter(f"this verb is for the drivers {', '.join(SERVOS)}")
    return register_bus(driver, hand, needed_port(driver, port))


def known_name(name: str, names: tuple[str, ...]) -> str:
    """A name that is one of `names`, checked as an option's value."""
    if name not in names:
        close = difflib.get_close_matches(name, names, 1)
        hint = f"; did you mean {close[0]}?" if close else f"; there are {', '.join(names)}"
        raise typer.BadParameter(f"no {name}{hint}")
    return name


def list_ids(hand: HandFiles, driver: str, port: str | None) -> None:
    """Which ids answer, and what the design has for them."""
    wanted = dict(zip(hand.numbers, hand.motors, strict=True))
    bus = servos_of(hand, driver, port)
    with closing(bus):
        there = bus.connect_only().scan(_SCANNED)
    table = Table("id", "servo", "motor of the design")
    for number in sorted({*there, *wanted}):
        table.add_row(str(number), there.get(number, "no answer"), wanted.get(number, ""))
    out.print(table)


def assign(hand: HandFiles, driver: str, port: str | None, motor: str, old: int | None) -> None:
    """Give a servo the id that the design has for a motor."""
    number = hand.numbers[hand.motors.index(known_name(motor, hand.motors))]
    bus = servos_of(hand, driver, port)
    with closing(bus):
        there = sorted(bus.connect_only().scan(_SCANNED))
        if old is None and len(there) != 1:
            said = ", ".join(map(str, there)) or "none"
            raise (ServoMismatch if there else ServoSilent)(
                f"{port}: ids that answer: {said}; connect one servo alone, or say --from"
            )
        old = there[0] if old is None else old
        if old != number:
            bus.assign(old, number)
    out.print(f"{motor} has id {number}")


def print_ports() -> None:
    """Serial ports with what the system knows of them."""
    found = sorted(list_ports.comports(), key=lambda port: port.device)
    if not found:
        console.print("no serial port is present; is the adapter plugged in?")
        return
    table = Table("port", "what", "maker", "serial number")
    for port in found:
        table.add_row(
            port.device, port.description, port.manufacturer or "", port.serial_number or ""
        )
    out.print(table)
