"""Arrays of a page in blocks of bytes: plain, or taken apart into byte planes and deflated."""

from __future__ import annotations

import base64
import zlib
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

MISSING = -32768
"""Quantized NaN."""
LARGEST = 32767
ALIGNED = 4
"""Bytes; arrays of a plain block start at multiples of it, where the page's script can read them."""


class Packer:
    """Collects arrays of one block; each gets a reference that the page's script can read it by.

    A reference holds `in`, the block's name, `at` and `n` (bytes and items in the block), `type`
    (`f4`, `i2`, `u1`, `i4`), `shape`, for quantized arrays `scale` and `offset`, and `delta` where
    rows hold differences.

    A plain block is larger, and the page's script reads its numbers where they lie: inflating a
    megabyte and putting planes together takes longer than all else that the page opens with.
    """

    def __init__(self, name: str, plain: bool = False) -> None:
        self.name = name
        self._plain = plain
        self._block = bytearray()

    def exact(self, values: ArrayLike) -> dict[str, Any]:
        """Numbers as 32 bit floats; NaN stays NaN."""
        return self._add(np.asarray(values, dtype="<f4"), "f4")

    def integers(self, values: ArrayLike) -> dict[str, Any]:
        """Whole numbers or truth values."""
        array = np.asarray(values)
        small = array.dtype == np.bool_ or (
            array.size == 0 or 0 <= array.min() <= array.max() < 256
        )
        return self._add(array.astype("u1" if small else "<i4"), "u1" if small else "i4")

    def quantized(self, values: ArrayLike, delta: bool = False) -> dict[str, Any]:
        """Numbers to 1/65,000 of their range; with `delta` the last axis holds differences."""
        array = np.asarray(values, dtype=np.float64)
        known = array[np.isfinite(array)]
        low, high = (known.min(), known.max()) if known.size else (0.0, 0.0)
        offset, scale = (low + high) / 2, max((high - low) / (2 * LARGEST), 1e-12)
        steps = np.where(np.isfinite(array), np.rint((array - offset) / scale), MISSING)
        steps = steps.astype("<i2")
        if delta:  # sums wrap around, in Python as in the page
            steps = np.diff(steps, axis=-1, prepend=np.zeros_like(steps[..., :1]))
        told = self._add(steps, "i2")
        return {**told, "scale": float(scale), "offset": float(offset), "delta": delta}

    def text(self) -> str:
        """The whole block in base64, deflated unless it is plain."""
        block = bytes(self._block)
        return base64.b64encode(block if self._plain else zlib.compress(block, 9)).decode("ascii")

    def _add(self, array: NDArray[Any], kind: str) -> dict[str, Any]:
        self._block += bytes(-len(self._block) % ALIGNED)
        at, size = len(self._block), array.dtype.itemsize
        flat = np.ascontiguousarray(array).ravel()
        planes = flat.view(np.uint8).reshape(-1, size)
        # Bytes of the same weight side by side: neighbours are alike, so they deflate better.
        self._block += (planes if self._plain else planes.T).tobytes()
        where = {"in": self.name, "at": at, "n": int(flat.size)}
        return {**where, "type": kind, "shape": list(array.shape)}
