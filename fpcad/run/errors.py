"""What can go wrong between host and motors: one class and one exit code a cause (docs/link.md)."""

from __future__ import annotations

from fpcad.errors import FpcadError


class RunError(FpcadError):
    """A run that could not start or did not reach its end."""

    exit_code = 20


class TrajectoryError(RunError):
    """The trajectory file is missing, damaged or does not fit the hand."""

    exit_code = 21


class LimitsError(RunError):
    """The trajectory leaves the joints' limits; nothing was sent."""

    exit_code = 22


class PortMissing(RunError):
    """There is no such port."""

    exit_code = 23


class PortForbidden(RunError):
    """The port exists, but this user may not open it."""

    exit_code = 24


class PortBusy(RunError):
    """Another program holds the port."""

    exit_code = 25


class PortUnusable(RunError):
    """The port opens, but is no serial port."""

    exit_code = 26


class ControllerSilent(RunError):
    """Nobody speaks our protocol at the other end."""

    exit_code = 27


class ProtocolMismatch(RunError):
    """The controller speaks another version of the protocol."""

    exit_code = 28


class JointMismatch(RunError):
    """The controller drives another number of joints."""

    exit_code = 29


class ConfigurationMismatch(RunError):
    """The controller was set up for another hand: limits or transmission differ."""

    exit_code = 30


class NotReady(RunError):
    """The controller is latched in HOLD, FAULT or ESTOP, or is not homed, or is busy."""

    exit_code = 31


class StartTooFar(RunError):
    """The hand is not where the trajectory starts."""

    exit_code = 32


class CommandRefused(RunError):
    """The controller refused a command or a knot."""

    exit_code = 33


class LinkLost(RunError):
    """The link broke in mid-run."""

    exit_code = 34


class ControllerReset(RunError):
    """The controller restarted in mid-run."""

    exit_code = 35


class ControllerFault(RunError):
    """The controller stopped because of a fault."""

    exit_code = 36


class ControllerHeld(RunError):
    """The controller held by itself: it heard nothing, or ran out of knots."""

    exit_code = 37


class HeldByUser(RunError):
    """Ctrl-C: the hand slowed down along its path and holds."""

    exit_code = 38


class StoppedByUser(RunError):
    """Ctrl-C twice, or a stop at the controller: torque is off."""

    exit_code = 39


class SimulatorError(RunError):
    """The simulated controller could not be started."""

    exit_code = 40
