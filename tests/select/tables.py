"""Small metrics tables for the tests of selection."""

from __future__ import annotations

import numpy as np
import pyarrow as pa

POSES = ("carve", "poke")


def metrics_table(n: int, **columns: object) -> pa.Table:
    """n equal hands that can be made, with the given columns in place of the usual values."""
    values: dict[str, object] = {"id": np.arange(n), "makeable": [True] * n, "reason": [""] * n}
    for pose in POSES:
        values |= {
            f"{pose}_tmr_deg": np.full(n, 50.0),
            f"{pose}_mss_mm_s": np.full(n, 1.0),
            f"{pose}_mft_nmm": np.full(n, 900.0),
            f"{pose}_mft_p90_nmm": np.full(n, 700.0),
        }
    return pa.table(values | columns)


def random_metrics(n: int, seed: int) -> pa.Table:
    """n hands with metrics at random, some of them without a path and some not makeable."""
    rng = np.random.default_rng(seed)
    columns: dict[str, object] = {"makeable": rng.random(n) < 0.8}
    for pose in POSES:
        lost = rng.random(n) < 0.1
        columns |= {
            f"{pose}_tmr_deg": np.where(lost, 0.0, rng.uniform(1, 150, n)),
            f"{pose}_mss_mm_s": pa.array(rng.uniform(0, 2, n), mask=lost),
            f"{pose}_mft_nmm": pa.array(rng.uniform(900, 10_000, n), mask=lost),
            f"{pose}_mft_p90_nmm": pa.array(rng.uniform(300, 9000, n), mask=lost),
        }
    return metrics_table(n, **columns)
