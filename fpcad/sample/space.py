"""The standardized design space: each free parameter mapped to [-0.5, 0.5]."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.spec.hand import Hand
from fpcad.spec.templates import TEMPLATES
from fpcad.units import internal_factor

Array = NDArray[np.float64]


@dataclass(frozen=True)
class DesignSpace:
    """Ranges of the design parameters in the units of their names [mm, deg].

    Values in those units are what tables hold; vectors in the mechanics' units are always computed
    from them, so that a stored design is bit for bit the one that was solved.
    """

    names: tuple[str, ...]
    lower: Array  # (n_d,) named units
    upper: Array  # (n_d,)

    @property
    def free(self) -> NDArray[np.bool_]:
        """(n_d,) which parameters are sampled."""
        return self.upper > self.lower

    def standardize(self, named: Array) -> Array:
        """Free parameters (..., n_free) in [-0.5, 0.5] of designs (..., n_d) in named units."""
        free = self.free
        return (named[..., free] - self.lower[free]) / (self.upper - self.lower)[free] - 0.5

    def named(self, standardized: Array) -> Array:
        """Inverse of :meth:`standardize`; held parameters get their value."""
        values = np.broadcast_to(self.lower, (*standardized.shape[:-1], len(self.names))).copy()
        free = self.free
        values[..., free] += (standardized + 0.5) * (self.upper - self.lower)[free]
        return values

    def internal(self, named: Array) -> Array:
        """Designs (..., n_d) in the mechanics' units [mm, rad]."""
        return named * np.array([internal_factor(name) for name in self.names])


def design_space(hand: Hand) -> DesignSpace:
    """The space that a hand's spec spans."""
    names = TEMPLATES[hand.template].parameters
    bounds = np.array([hand.parameters[name].bounds for name in names])
    return DesignSpace(names, bounds[:, 0], bounds[:, 1])
