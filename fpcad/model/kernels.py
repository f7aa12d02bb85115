"""The compiled formulas of one pose: all numbers that solvers, paths and checks ask for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import casadi as ca

from fpcad.model.compile import (
    Kernel,
    cache_key,
    dense_function,
    jacobian_transposed,
    load_function,
)
from fpcad.model.pose import PoseModel, StateLayout
from fpcad.spec.schema import Spec


@dataclass(frozen=True)
class PoseKernels:
    """Formulas of one pose. d: design; y = [h, u, a]: pose state; x = [u, a]; turn: tool angle.

    Lengths in mm, angles in rad. n contacts, n_u joints, m_g margins, m facets a cone.
    """

    layout: StateLayout
    foundational: Kernel
    """(d, y) -> cost residuals, their Jacobian, rows (5n,), Jacobian, margins (m_g,), Jacobian."""
    projection: Kernel
    """(d, h, turn, x) -> rows (5n,), Jacobian in x, margins (m_g,), Jacobian in x."""
    rates: Kernel
    """(d, h, turn, x) -> rows affine in the joint rates; see :func:`rates_function`."""
    statics: Kernel
    """(d, h, turn, x) -> edge wrenches (6, n m), edge torques (n_u, n m), tip wrench (6,)."""
    residual: Kernel
    """(d, turn, y) -> paper's six (6n,), opposition (n,), skin margins (2n,), clearances."""


def load_kernels(spec: Spec, pose: str, cache: Path) -> PoseKernels:
    """Formulas of one pose of a spec, compiled at first use and kept in `cache`."""
    sections = (spec.tool, spec.hand, spec.poses[pose], spec.statics, spec.bounds)
    key = cache_key(*(section.model_dump_json() for section in sections))
    model = PoseModel(spec, pose)
    builders: dict[str, Callable[[PoseModel], ca.Function]] = {
        "foundational": foundational_function,
        "projection": projection_function,
        "rates": rates_function,
        "statics": statics_function,
        "residual": residual_function,
    }
    kernels = {
        name: Kernel(load_function(lambda build=build: build(model), name, key, cache))
        for name, build in builders.items()
    }
    return PoseKernels(layout=model.layout, **kernels)


def foundational_function(model: PoseModel) -> ca.Function:
    """Cost, constraint rows and margins of a pose, the tool unturned, with Jacobians in y."""
    y = ca.SX.sym("y", model.layout.size)
    outputs = []
    for expression in (model.cost(), model.rows(), _margins(model)):
        outputs += [expression, jacobian_transposed(expression, model.y)]
    parts = [y[model.layout.hand], y[model.layout.joints], y[model.layout.contacts]]
    symbols = [model.turn, model.h, model.u, model.a]
    bound = ca.substitute(outputs, symbols, [ca.SX(0), *parts])
    return dense_function("foundational", [model.d, y], bound)


def projection_function(model: PoseModel) -> ca.Function:
    """Constraint rows and margins on a path, with Jacobians in x = [u, a]."""
    rows, margins = model.rows(), _margins(model)
    x = ca.vertcat(model.u, model.a)
    outputs = [rows, jacobian_transposed(rows, x), margins, jacobian_transposed(margins, x)]
    return _path_function("projection", model, outputs)


def rates_function(model: PoseModel) -> ca.Function:
    """What the rate program needs, as (matrix on the joint rates, constant at tool rate 1 rad/s).

    Outputs: sliding (2n, n_u), (2n,) [mm/s]; approach (n, n_u), (n,) [mm/s]; contact rates
    (4n, n_u), (4n,) [mm/s, rad/s]; margins (m,) [mm]; their rates (m, n_u), (m,) [mm/s];
    normalized determinants of the relative curvatures (n,).
    """
    u_rate, turn_rate = ca.SX.sym("u_rate", model.layout.n_u), ca.SX.sym("turn_rate")
    motions = model.relative_motions(u_rate, turn_rate)
    contacts = model.contact_rates(motions)
    a_rate = ca.vertcat(*[ca.vertcat(c.tool, c.finger) for c in contacts])
    margins = ca.vertcat(model.skin_margin(), model.collision_margin())
    symbols = ca.vertcat(model.turn, model.u, model.a)
    margin_rate = ca.jtimes(margins, symbols, ca.vertcat(turn_rate, u_rate, a_rate))
    outputs = []
    for rate in (
        ca.vertcat(*[m.sliding for m in motions]),
        ca.vertcat(*[m.approach for m in motions]),
        a_rate,
    ):
        outputs += [jacobian_transposed(rate, u_rate), ca.jacobian(rate, turn_rate)]
    outputs += [
        margins,
        jacobian_transposed(margin_rate, u_rate),
        ca.jacobian(margin_rate, turn_rate),
        ca.vertcat(*[c.determinant for c in contacts]),
    ]
    return _path_function("rates", model, outputs)


def statics_function(model: PoseModel) -> ca.Function:
    """Friction cones' edges and the tip force of 1 N, as wrenches and joint torques."""
    edges = model.cone_edges()
    return _path_function("statics", model, [edges.wrench.T, edges.torque.T, model.tip_wrench()])


def residual_function(model: PoseModel) -> ca.Function:
    """The measures that an accepted state is judged by, without derivatives."""
    y = ca.SX.sym("y", model.layout.size)
    outputs = [
        model.residual(),
        model.opposition_margin(),
        model.skin_margin(),
        model.clearances(),
    ]
    parts = [y[model.layout.hand], y[model.layout.joints], y[model.layout.contacts]]
    bound = ca.substitute(outputs, [model.h, model.u, model.a], parts)
    return dense_function("residual", [model.d, model.turn, y], bound)


def _margins(model: PoseModel) -> ca.SX:
    """All margins >= 0; the opposition counts in mm like a deviation of normals."""
    return ca.vertcat(
        model.opposition_margin() * 10.0, model.skin_margin(), model.collision_margin()
    )


def _path_function(name: str, model: PoseModel, outputs: list[ca.SX]) -> ca.Function:
    x = ca.SX.sym("x", model.layout.size - 6)
    n_u = model.layout.n_u
    bound = ca.substitute(outputs, [model.u, model.a], [x[:n_u], x[n_u:]])
    return dense_function(name, [model.d, model.h, model.turn, x], bound)
