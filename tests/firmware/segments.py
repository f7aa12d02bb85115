"""Random segments of one joint, the same on every target: integers from one generator."""

from __future__ import annotations

import numpy as np

MASK = 2**32 - 1
DRAWS = 9
"""Of the generator for one segment."""
PIECE = 500
"""Segments that a target is asked for at a time."""


def xorshift(state: int) -> int:
    """Next state of Marsaglia's 32-bit generator; ports/bench_main.c has the same."""
    state ^= state << 13 & MASK
    state ^= state >> 17
    return state ^ (state << 5 & MASK)


def first_state(seed: int) -> int:
    return seed * 2654435761 % MASK + 1


def starts_of_pieces(count: int, seed: int) -> list[int]:
    """States of the generator before each piece of `count` segments."""
    state, starts = first_state(seed), []
    for number in range(count):
        if number % PIECE == 0:
            starts.append(state)
        for _ in range(DRAWS):
            state = xorshift(state)
    return starts


def random_segments(count: int, seed: int) -> np.ndarray:
    """Rows (count, 9): t p v a, t p v a, elapsed; us and counts of 1e-6.

    Rough motions of a hand: within the fixed point's range, far outside the limits.
    """
    state = first_state(seed)
    rows = np.zeros((count, 9), np.int64)
    for row in rows:
        draws = []
        for _ in range(DRAWS):
            state = xorshift(state)
            draws.append(state)
        duration = 30_000 + draws[0] % 70_000
        start = draws[1] % 1_200_000
        velocities = [draws[k] % 2_000_001 - 1_000_000 for k in (3, 4)]
        # Rounded towards zero, as C divides.
        way = int(sum(velocities) * duration / 2_000_000) + draws[2] % 2_001 - 1_000
        accelerations = [draws[k] % 24_000_001 - 12_000_000 for k in (5, 6)]
        row[:] = (
            0, start, velocities[0], accelerations[0],
            duration, start + way, velocities[1], accelerations[1],
            draws[7] % (duration + 1),
        )  # fmt: skip
    return rows
