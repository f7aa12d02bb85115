"""Evaluating a candidate: its paths from all poses, and their metrics."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fpcad.errors import MakeError
from fpcad.model.compile import Kernel
from fpcad.model.pose import HAND_SIZE
from fpcad.model.statics import cone_facets
from fpcad.model.transmission import hand_transmission
from fpcad.solve.attempt import Workbench
from fpcad.solve.program import path_bounds
from fpcad.solve.qp import BACKENDS
from fpcad.spec.catalogue import motor
from fpcad.spec.schema import Spec
from fpcad.spec.templates import TEMPLATES
from fpcad.units import NM_PER_NMM, RAD_PER_DEG
from fpcad.wield.graph import GraphSettings, step_graph
from fpcad.wield.integrate import PROJECTION, project
from fpcad.wield.load import Load
from fpcad.wield.metrics import PathMetrics, path_metrics
from fpcad.wield.path import WieldingPath, join_traces
from fpcad.wield.rates import Mechanism
from fpcad.wield.touch import nearest_contacts
from fpcad.wield.trace import Stepping, trace

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Evaluation:
    """Paths and metrics of one candidate, by pose."""

    paths: dict[str, WieldingPath]
    metrics: dict[str, PathMetrics]


def evaluate(bench: Workbench, design: Array, states: Mapping[str, Array]) -> Evaluation:
    """Trace and measure the paths of a hand.

    Args:
        design: (n_d,) [mm, rad].
        states: state y of each pose, in contact.
    """
    paths, metrics = {}, {}
    for pose, y in states.items():
        mechanism = build_mechanism(bench, pose, design, y)
        load, stepping = build_load(bench.spec, pose), build_stepping(bench.spec)
        minus, plus = (
            trace(mechanism, load, y[HAND_SIZE:], direction, stepping) for direction in (-1.0, 1.0)
        )
        layout = bench.kernels[pose].layout
        path = join_traces(pose, layout, y[:HAND_SIZE], minus, plus)
        paths[pose] = path
        metrics[pose] = path_metrics(path, minus, plus, stepping.step)
    return Evaluation(paths, metrics)


def motion_range(bench: Workbench, pose: str, design: Array, y: Array) -> float:
    """Tool motion range [deg] of one pose: the merit of a first hand's poses."""
    return evaluate(bench, design, {pose: y}).metrics[pose].tmr_deg


def contact_projector(
    bench: Workbench, design: Array, path: WieldingPath
) -> Callable[[float, Array], Array]:
    """The function that corrects a guessed posture on a path to exact contact.

    It takes a tool angle [rad] and joints (n_u,) [rad] and returns joints (n_u,) [rad]. It raises
    :class:`MakeError` where there is no contact.
    """
    hand = path.hand_in_tool
    y = np.concatenate([hand, path.joints_rad[0].ravel(), path.contacts[0].ravel()])
    mechanism = build_mechanism(bench, path.pose, design, y)

    def to_contact(turn: float, guess: Array) -> Array:
        contacts = nearest_contacts(bench, path.pose, design, hand, turn, guess)
        state = project(mechanism, turn, np.concatenate([guess, contacts.ravel()]))
        if state is None:
            raise MakeError(f"{path.pose}: no contact at a tool angle of {turn:.4f} rad")
        return state[: len(guess)]

    return to_contact


def build_mechanism(bench: Workbench, pose: str, design: Array, y: Array) -> Mechanism:
    """The mechanism that tool and hand form at a pose with state y."""
    settings, kernels = bench.spec.path, bench.kernels[pose]
    return Mechanism(
        kernels=kernels,
        bounds=path_bounds(bench.spec, pose, kernels.layout),
        design=design,
        hand=y[:HAND_SIZE],
        rate_weight=settings.rate_weight,
        max_joint_rate=settings.max_joint_rate,
        qp=BACKENDS[settings.qp],
        graph=build_graph(bench, pose) if settings.qp == "daqp" else None,
    )


def build_graph(bench: Workbench, pose: str) -> Kernel:
    """The graph that steps along paths from a pose; built once, whatever the hand."""
    settings, kernels = bench.spec.path, bench.kernels[pose]
    lower, upper = path_bounds(bench.spec, pose, kernels.layout)
    return step_graph(
        kernels,
        GraphSettings(
            lower=tuple(lower.tolist()),
            upper=tuple(upper.tolist()),
            rate_weight=settings.rate_weight,
            max_joint_rate=settings.max_joint_rate,
            max_correction=PROJECTION.max_trust,
            contact_tolerance=PROJECTION.feasibility,
        ),
    )


def build_load(spec: Spec, pose: str) -> Load:
    """Tip force, torque cap, motors and friction of a pose."""
    A = hand_transmission(spec.motors.transmission, len(TEMPLATES[spec.hand.template].fingers))
    limit = motor(spec.motors.type).continuous_torque_nm / NM_PER_NMM
    return Load(
        tip_force_n=spec.poses[pose].tip_force_n,
        max_joint_torque_nmm=spec.statics.max_joint_torque_nmm,
        motor_per_joint_torque=np.asarray(np.linalg.inv(A.T), dtype=np.float64),
        motor_torque_nmm=np.full(len(A), limit),
        cone_facets=cone_facets(spec.statics),
    )


def build_stepping(spec: Spec) -> Stepping:
    """Step lengths of a spec's paths [rad]."""
    path = spec.path
    return Stepping(
        path.step_deg * RAD_PER_DEG,
        path.end_tolerance_deg * RAD_PER_DEG,
        path.max_turn_deg * RAD_PER_DEG,
    )
