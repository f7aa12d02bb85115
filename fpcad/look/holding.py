"""Contact forces with which a hand holds the tool against the force at its tip."""

from __future__ import annotations

from collections.abc import Iterator

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from fpcad.model.equilibrium import least_torque
from fpcad.model.pose import PoseModel
from fpcad.model.statics import cone_facets
from fpcad.spec.schema import Spec

Array = NDArray[np.float64]


class HoldingForces:
    """The equilibrium with the least joint torque of one pose, without compiled formulas."""

    def __init__(self, spec: Spec, pose: str) -> None:
        model = PoseModel(spec, pose)
        forces = model.cone_axes()
        inputs = [model.d, model.h, model.turn, ca.vertcat(model.u, model.a)]
        outputs = [forces.wrench, forces.torque, model.tip_wrench()]
        self._statics = ca.Function("statics", inputs, outputs)
        self.layout, self._load_n = model.layout, spec.poses[pose].tip_force_n
        self._cap, self._facets = spec.statics.max_joint_torque_nmm, cone_facets(spec.statics)

    def at(self, design: Array, hand: Array, turn: Array, x: Array, pull: Array) -> Array:
        """Forces [N] of the fingers on the tool, in O.

        Args:
            design: (n_d,) [mm, rad], or (N, n_d).
            hand: (6,) pose of H in O [mm, rad], or (N, 6).
            turn: (N,) tool angles [rad].
            x: (N, n_u + 4 n) joints and contact coordinates.
            pull: (N,) +1 where the tip is held against turning to plus, -1 to minus.

        Returns:
            (N, n, 3); NaN where nothing holds.
        """
        n = self.layout.n_contacts
        forces = np.full((len(turn), n, 3), np.nan)
        for row, (wrench, torque, tip) in enumerate(self._evaluated(design, hand, turn, x)):
            load = pull[row] * self._load_n * tip
            holding = least_torque(wrench, torque, load, self._cap, self._facets)
            if holding is not None:
                along = wrench[:3].T * holding.forces_n[:, None]
                forces[row] = along.reshape(n, 3, 3).sum(axis=1)
        return forces

    def _evaluated(
        self, design: Array, hand: Array, turn: Array, x: Array
    ) -> Iterator[tuple[Array, Array, Array]]:
        many = len(turn)
        designs, hands = (np.broadcast_to(v, (many, v.shape[-1])) for v in (design, hand))
        for row in range(many):
            wrench, torque, tip = self._statics(designs[row], hands[row], turn[row], x[row])
            yield np.array(wrench), np.array(torque), np.array(tip).ravel()
