"""Which command leads from which state to which: the table that every controller implements."""

from __future__ import annotations

from fpcad.run.messages import (
    Arm,
    Calibrate,
    Clear,
    End,
    Estop,
    Hold,
    Home,
    Knot,
    Start,
    State,
)

_LATCHED = (State.HOLD, State.FAULT, State.ESTOP)

NEXT: dict[tuple[State, type], State] = {
    (State.READY, Arm): State.ARMED,
    (State.ARMED, Knot): State.ARMED,
    (State.RUNNING, Knot): State.RUNNING,
    (State.ARMED, Start): State.RUNNING,
    (State.ARMED, End): State.ARMED,
    (State.RUNNING, End): State.RUNNING,
    (State.READY, Clear): State.READY,
    **{(state, Home): State.HOMING for state in (State.IDLE, State.READY)},
    **{(state, Calibrate): State.READY for state in (State.IDLE, State.READY)},
    **{(state, Clear): State.READY for state in _LATCHED},
    # Hold and Estop are answered in every state. Hold cannot improve on a state that is stopped
    # already; Estop always wins.
    **{(state, Hold): state for state in State},
    **{(state, Hold): State.HOLD for state in (State.READY, State.ARMED, State.RUNNING)},
    # What homing has not found yet is not known, so a stop leads back.
    (State.HOMING, Hold): State.IDLE,
    **{(state, Estop): State.ESTOP for state in State},
}
"""(state, command) -> next state; a pair that is not in the table is refused as WRONG_STATE."""
