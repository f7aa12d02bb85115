"""The controller's clock is master; the host estimates it from the times that it reports."""

from __future__ import annotations

from collections import deque

import numpy as np

_SAMPLES = 64
_SHORTEST_SPAN_S = 0.02


class DeviceClock:
    """A straight line through (host time, controller time) pairs: offset and drift."""

    def __init__(self) -> None:
        self._samples: deque[tuple[float, float]] = deque(maxlen=_SAMPLES)

    def add(self, host_s: float, device_us: int) -> None:
        """One report of the controller's time, heard at `host_s`."""
        self._samples.append((host_s, float(device_us)))

    @property
    def ready(self) -> bool:
        """Whether samples span long enough to tell the drift."""
        return bool(self._samples) and self._samples[-1][0] - self._samples[0][0] > _SHORTEST_SPAN_S

    def device_us(self, host_s: float) -> int:
        """Controller's time [us] at a time of the host [s], least squares."""
        host, device = np.array(self._samples).T
        drift, offset = np.polyfit(host - host[-1], device - device[-1], 1)
        return round(device[-1] + offset + drift * (host_s - host[-1]))
