"""Attempting the poses of a new hand from those of a neighbour."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from fpcad.model.equilibrium import least_torque
from fpcad.model.hand import HandTemplate, hand_template
from fpcad.model.kernels import PoseKernels, load_kernels
from fpcad.model.pose import HAND_SIZE
from fpcad.model.statics import cone_facets
from fpcad.solve.ipopt import build_ipopt, solve_ipopt
from fpcad.solve.measure import Residual, measure
from fpcad.solve.program import build_pose_program, pose_bounds
from fpcad.solve.sqp import SqpSettings, solve_sqp
from fpcad.spec.schema import Spec

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Workbench:
    """A spec with its compiled formulas: what every worker needs."""

    spec: Spec
    template: HandTemplate
    kernels: dict[str, PoseKernels]
    references: dict[str, ca.Function]
    """IPOPT solvers, where the spec asks for them."""


@dataclass(frozen=True)
class SolvedPose:
    """A pose of one hand, with its measured residual."""

    y: Array  # (layout.size,) [mm, rad]
    cost: float
    residual: Residual
    iterations: int


@dataclass(frozen=True)
class Attempt:
    """A hand design with its poses, or the reason why it has none."""

    design: Array  # (n_d,) [mm, rad]
    poses: dict[str, SolvedPose]
    reason: str
    """Empty when all poses were reached and are held; else like `name: statics`."""

    @property
    def succeeded(self) -> bool:
        return not self.reason


def open_workbench(spec: Spec, cache: Path) -> Workbench:
    """Load the formulas of all poses, compiling them at first use into the folder `cache`."""
    kernels = {pose: load_kernels(spec, pose, cache) for pose in spec.poses}
    with_ipopt = spec.solver.method == "ipopt"
    references = {pose: build_ipopt(spec, pose) for pose in spec.poses} if with_ipopt else {}
    return Workbench(spec, hand_template(spec.hand), kernels, references)


def solve_pose(bench: Workbench, pose: str, design: Array, start: Array) -> SolvedPose | None:
    """One pose of one hand from a start (layout.size,); None when no acceptable state is found."""
    kernels = bench.kernels[pose]
    program = build_pose_program(bench.spec, pose, kernels, design)
    if pose in bench.references:
        result = solve_ipopt(bench.references[pose], program, design, start)
    else:
        settings = SqpSettings(max_iterations=bench.spec.solver.max_iterations)
        result = solve_sqp(program, start, settings)
    bounds = pose_bounds(bench.spec, pose, kernels.layout)
    residual = measure(kernels, design, 0.0, result.y, bounds)
    if not residual.acceptable:
        return None
    return SolvedPose(result.y, result.cost, residual, result.iterations)


def held(bench: Workbench, pose: str, design: Array, y: Array) -> bool:
    """Whether the tool is in equilibrium with the tip force against either turning direction."""
    statics, force = bench.spec.statics, bench.spec.poses[pose].tip_force_n
    wrench, torque, tip = bench.kernels[pose].statics(design, y[:HAND_SIZE], 0.0, y[HAND_SIZE:])
    cap, facets = statics.max_joint_torque_nmm, cone_facets(statics)
    return all(
        least_torque(wrench, torque, sign * force * tip, cap, facets) for sign in (1.0, -1.0)
    )


def attempt(bench: Workbench, design: Array, neighbour: dict[str, Array]) -> Attempt:
    """Try all poses of a design (n_d,) [mm, rad] from a neighbour's states; the first failure ends it."""
    poses: dict[str, SolvedPose] = {}
    if not bench.template.feasible(design):
        return Attempt(design, poses, "geometry")
    for pose in bench.spec.poses:
        solved = solve_pose(bench, pose, design, neighbour[pose])
        if solved is None:
            return Attempt(design, poses, f"{pose}: solve")
        poses[pose] = solved
    for pose, solved in poses.items():
        if not held(bench, pose, design, solved.y):
            return Attempt(design, poses, f"{pose}: statics")
    return Attempt(design, poses, "")
