"""What can go wrong between host and motors: one class and one exit code a cause (docs/link.md)."""

from __future__ import annotations

from typing import Self

from fpcad.errors import FpcadError


class RunError(FpcadError):
    """A run that could not start or did not reach its end."""

    exit_code = 20
    hand = "The hand did not move."
    """What state the hand is in, unless who raises it knows better; follows every message."""

    def __str__(self) -> str:
        said = super().__str__()
        end = "" if said.endswith((".", "?")) else "."
        return f"{said}{end} {self.hand}" if self.hand else said

    def leaving(self, hand: str) -> Self:
        """The same error with another sentence on the state of the hand."""
        self.hand = hand
        return self


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
    hand = "It slows down if it moved, and holds."


class LinkLost(RunError):
    """The link broke in mid-run."""

    exit_code = 34
    hand = "Its controller slows it down half a second after the last word, and holds it."


class ControllerReset(RunError):
    """The controller restarted in mid-run."""

    exit_code = 35
    hand = "A controller that restarts leaves the hand where it is."


class ControllerFault(RunError):
    """The controller stopped because of a fault."""

    exit_code = 36
    hand = "The other joints slow down and hold."


class ControllerHeld(RunError):
    """The controller held by itself: it heard nothing, or ran out of knots."""

    exit_code = 37
    hand = "It holds where it came to rest."


class HeldByUser(RunError):
    """Ctrl-C: the hand slowed down along its path and holds."""

    exit_code = 38
    hand = ""


class StoppedByUser(RunError):
    """Ctrl-C twice, or a stop at the controller: torque is off."""

    exit_code = 39
    hand = ""


class SimulatorError(RunError):
    """The simulated controller could not be started."""

    exit_code = 40


class ServoSilent(RunError):
    """A servo on the bus does not answer, or what it answers cannot be read."""

    exit_code = 41


class ServoMismatch(RunError):
    """A servo answers that is not the one that the design names: another type, or an id twice."""

    exit_code = 42


class ServoFault(RunError):
    """A servo is overloaded, too hot, reports a fault, or does not follow its goal."""

    exit_code = 43


class WatchdogTripped(RunError):
    """The servos stopped by themselves, for the host was silent too long."""

    exit_code = 44
    hand = "Its servos stand where they stopped."


class CalibrationError(RunError):
    """There is no calibration of this hand, or it is damaged, implausible or of another hand."""

    exit_code = 45


class HomingError(RunError):
    """Homing did not find the ends of a joint where the design has them."""

    exit_code = 46


class CollisionError(RunError):
    """The trajectory would bring parts of the hand together; nothing was sent."""

    exit_code = 47


class MotorLimitsError(RunError):
    """The joints could move so, their motors could not; nothing was sent."""

    exit_code = 48


class GoalRefused(RunError):
    """A goal for motors that is no number, of another count, or out of their range; not sent."""

    exit_code = 49
    hand = ""
