"""The compiled formulas of one pose: all numbers that solvers, paths and checks ask for."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path

import casadi as ca

from fpcad.model.compile import (
    Kernel,
    cache_key,
    dense_function,
    jacobian_transposed,
    load_functions,
)
from fpcad.model.pose import HAND_SIZE, PoseModel, StateLayout
from fpcad.model.programs import PATH_FUNCTIONS, PathFunctions
from fpcad.spec.schema import Spec


@dataclass(frozen=True)
class PoseKernels:
    """Formulas of one pose. d: design; y = [h, u, a]: pose state; x = [u, a]; turn: tool angle.

    Lengths in mm, angles in rad. n contacts, n_u joints, m_g margins, m facets a cone.
    """

    layout: StateLayout
    constraints: Kernel
    """(d, turn, y) -> cost residuals, rows (5n,) and margins (m_g,), each followed by its Jacobian
    in [y, turn]."""
    rates: Kernel
    """(d, h, turn, x) -> motions that are affine in the joint rates; see :func:`rates_function`."""
    statics: Kernel
    """(d, h, turn, x) -> wrenches (6, 3n) and torques (n_u, 3n) of unit contact forces, tip wrench (6,)."""
    residual: Kernel
    """(d, turn, y) -> paper's six (6n,), opposition (n,), skin margins (2n,), clearances."""
    path: PathFunctions
    """The programs that a path is traced by, for graphs to call."""


def load_kernels(spec: Spec, pose: str, cache: Path) -> PoseKernels:
    """Formulas of one pose of a spec, compiled at first use and kept in `cache`."""
    sections = (spec.tool, spec.hand, spec.poses[pose], spec.statics, spec.bounds)
    key = cache_key(*(section.model_dump_json() for section in sections))
    model = PoseModel(spec, pose)
    builders = {
        "constraints": partial(constraints_function, model),
        "rates": partial(rates_function, model),
        "statics": partial(statics_function, model),
        "residual": partial(residual_function, model),
    }
    of_paths = {name: partial(build, model) for name, build in PATH_FUNCTIONS.items()}
    functions = load_functions(builders | of_paths, key, cache)
    kernels = {name: Kernel(functions[name]) for name in builders}
    path = PathFunctions(**{name: functions[name] for name in of_paths})
    return PoseKernels(layout=model.layout, **kernels, path=path)


def constraints_function(model: PoseModel) -> ca.Function:
    """Cost, constraint rows and margins, with Jacobians in the state y and the tool angle."""
    variables = ca.vertcat(model.y, model.turn)
    outputs = []
    for expression in (model.cost(), model.rows(), model.margins()):
        outputs += [expression, jacobian_transposed(expression, variables)]
    return _state_function("constraints", model, outputs)


def rates_function(model: PoseModel) -> ca.Function:
    """What the rate program needs, as (matrix on the joint rates, constant at tool rate 1 rad/s).

    Outputs: sliding (2n, n_u), (2n,) [mm/s]; approach (n, n_u), (n,) [mm/s]; contact rates
    (4n, n_u), (4n,) [mm/s, rad/s]; normalized determinants of the relative curvatures (n,).
    """
    u_rate, turn_rate = ca.SX.sym("u_rate", model.layout.n_u), ca.SX.sym("turn_rate")
    motions = model.relative_motions(u_rate, turn_rate)
    contacts = model.contact_rates(motions)
    outputs = []
    for rate in (
        ca.vertcat(*[m.sliding for m in motions]),
        ca.vertcat(*[m.approach for m in motions]),
        ca.vertcat(*[ca.vertcat(c.tool, c.finger) for c in contacts]),
    ):
        outputs += [jacobian_transposed(rate, u_rate), ca.jacobian(rate, turn_rate)]
    outputs.append(ca.vertcat(*[c.determinant for c in contacts]))
    return _path_function("rates", model, outputs)


def statics_function(model: PoseModel) -> ca.Function:
    """Unit forces along the friction cones' axes and at the tip, as wrenches and joint torques."""
    forces = model.cone_axes()
    return _path_function("statics", model, [forces.wrench.T, forces.torque.T, model.tip_wrench()])


def residual_function(model: PoseModel) -> ca.Function:
    """The measures that an accepted state is judged by, without derivatives."""
    outputs = [
        model.residual(),
        model.opposition_margin(),
        model.skin_margin(),
        model.clearances(),
    ]
    return _state_function("residual", model, outputs)


def _state_function(name: str, model: PoseModel, outputs: list[ca.SX]) -> ca.Function:
    """Outputs as a function of (d, turn, y)."""
    y = ca.SX.sym("y", model.layout.size)
    parts = [y[model.layout.hand], y[model.layout.joints], y[model.layout.contacts]]
    bound = ca.substitute(outputs, [model.h, model.u, model.a], parts)
    return dense_function(name, [model.d, model.turn, y], bound)


def _path_function(name: str, model: PoseModel, outputs: list[ca.SX]) -> ca.Function:
    """Outputs as a function of (d, h, turn, x), x = [u, a]."""
    n_u = model.layout.n_u
    x = ca.SX.sym("x", model.layout.size - HAND_SIZE)
    bound = ca.substitute(outputs, [model.u, model.a], [x[:n_u], x[n_u:]])
    return dense_function(name, [model.d, model.h, model.turn, x], bound)
