"""The Pareto front: hands that no other hand beats in one score without losing in another."""

from __future__ import annotations

import moocore
import numpy as np
from numpy.typing import NDArray


def pareto_front(scores: NDArray[np.float64], makeable: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which hands are on the front, all scores to be made large.

    Args:
        scores: (n, m), finite.
        makeable: (n,) hands that take part; the others neither are on the front nor keep a hand
            off it.

    Returns:
        (n,) True on the front. Hands with equal scores are on it together or not at all.
    """
    if not np.isfinite(scores).all():
        raise ValueError("scores must be finite")
    front = np.zeros(len(scores), dtype=bool)
    if makeable.any():
        front[makeable] = moocore.is_nondominated(scores[makeable], maximise=True, keep_weakly=True)
    return front
