"""What a check is: a name, what must hold, and a function that yields every fault it finds."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from fpcad.check_description.package import Package
from fpcad.check_description.urdf import Urdf


@dataclass(frozen=True)
class Fault:
    """Something wrong, and with what."""

    subject: str
    message: str


class NotApplicableError(Exception):
    """There is nothing to check; the message says why."""


@dataclass(frozen=True)
class Check:
    """One rule that descriptions keep."""

    name: str
    rule: str
    """What must hold, in a few words."""
    faults: Callable[[Package, Urdf], Iterator[Fault]]
