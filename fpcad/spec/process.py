"""How a hand is searched for: statics, bounds, solver, sampling, paths and selection."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from fpcad.spec.base import Fraction, NonNegative, Positive, SpecModel


class Statics(SpecModel):
    """When a pose counts as held."""

    friction: Positive = 0.8
    """Coulomb coefficient of friction between skin and tool [-]."""
    cone_facets: Annotated[int, Field(ge=3, le=64)] = 8
    """Edges of the pyramid that stands for the friction cone."""
    max_joint_torque_nmm: Positive = 10_000.0
    """Largest joint torque with which an equilibrium still counts [N mm]."""


class Bounds(SpecModel):
    """Bounds on poses and paths that neither the hand nor the tool imply."""

    hand_position_mm: Positive = 150.0
    """Largest absolute coordinate of the hand frame in O [mm]."""
    hand_rotation_deg: Positive = 229.2
    """Largest absolute roll, pitch or yaw [deg]; over 180, so that no wrap lies at a bound."""
    finger_angle_deg: Annotated[float, Field(gt=0, lt=180)] = 100.0
    """Largest absolute angle of a contact about its link at a pose [deg]."""
    path_finger_angle_deg: Annotated[float, Field(gt=0, lt=180)] = 120.0
    """Largest absolute angle of a contact about its link on a path [deg]."""
    apex_fraction: Annotated[float, Field(gt=0, lt=1)] = 0.9
    """How far towards the fingertip's apex, a pole of the chart, a contact may go [-]."""
    skin_edge_mm: NonNegative = 1.0
    """Distance that contacts keep from the skin's edges [mm]."""
    opposition: Annotated[float, Field(ge=0, lt=1)] = 0.5
    """Least -(n_finger . n_tool), which excludes the wrong branch of the contact rows [-]."""


class Solver(SpecModel):
    """How poses are solved."""

    method: Literal["sqp", "ipopt"] = "sqp"
    """`sqp`: trust-region Gauss-Newton over DAQP; `ipopt`: interior point, the slow reference."""
    max_iterations: Annotated[int, Field(ge=1, le=10_000)] = 60
    """Iterations after which a solve is given up."""
    starts: Annotated[int, Field(ge=1, le=1_000_000)] = 256
    """Random starts for each pose of a design, when the spec gives no `initial`."""
    start_designs: Annotated[int, Field(ge=1, le=1_000_000)] = 100
    """Designs that are tried for a first hand, when the spec gives no `initial`."""


class Sampling(SpecModel):
    """The rapidly exploring random tree over the standardized design space."""

    candidates: Annotated[int, Field(ge=1, le=10_000_000)] = 64
    """Number of hands at which sampling stops."""
    seed: Annotated[int, Field(ge=0, lt=2**63)] = 1
    """Seed of all random choices."""
    step: Fraction = 0.05
    """Longest step from a candidate towards a sample, in standardized units."""
    min_distance: Fraction = 1 / 30
    """Least distance between two candidates, in standardized units."""
    batch: Annotated[int, Field(ge=1, le=4096)] = 8
    """Proposals made from one tree and solved side by side; another number gives other hands."""
    efficiency_window: Annotated[int, Field(ge=1)] = 1_000
    """Number of last calls over which the sampling efficiency is averaged."""
    min_efficiency: Annotated[float, Field(ge=0, lt=1)] = 0.01
    """Mean efficiency over the window below which sampling stops [-]."""
    max_calls: Annotated[int, Field(ge=1)] = 1_000_000
    """Number of calls at which sampling stops."""


class Path(SpecModel):
    """Wielding paths."""

    step_deg: Annotated[float, Field(gt=0, le=10)] = 1.0
    """Turn of the tool in one integration step [deg]."""
    end_tolerance_deg: Annotated[float, Field(gt=0, le=10)] = 0.05
    """How sharply the end of a path is located by bisection [deg]."""
    max_turn_deg: Annotated[float, Field(gt=0, le=360)] = 180.0
    """Turn in one direction at which a path is complete [deg]."""
    rate_weight: Positive = 1.0
    """Weight [mm^2] of the squared joint rates beside the squared sliding speeds."""
    max_joint_rate: Positive = 5.0
    """Largest turn of a joint for one of the tool [-]; near a singular posture there is no bound."""
    qp: Literal["daqp", "osqp"] = "daqp"
    """Solver of the rate program; `osqp` is the slower cross-check."""
    keep: Literal["all", "front", "selected"] = "front"
    """Whose path states are kept: all candidates', the Pareto front's or the selected one's."""


class Resolutions(SpecModel):
    """Differences below which two values of a metric count as equal."""

    tmr_deg: Positive = 0.1
    """Tool motion range [deg]."""
    mss_mm_s: Positive = 1e-3
    """Mean sliding speed at a tool rate of 1 rad/s [mm/s]."""
    mft_nmm: Positive = 1.0
    """Finger torque [N mm]."""


class Selection(SpecModel):
    """How one candidate is chosen."""

    rule: Literal["best_mean_on_front", "best_mean", "best_worst_score"] = "best_mean_on_front"
    """Best mean score on the Pareto front, best mean score of all, or best lowest score."""
    torque: Literal["mft_p90", "mft"] = "mft_p90"
    """Torque metric that is scored: 90th percentile along the path, or its maximum."""
    simulate: Annotated[int, Field(ge=0)] = 0
    """How many of the best hands are tried in MuJoCo before one is chosen; 0 for none. Needs the
    extra `physics`."""
    resolutions: Resolutions = Resolutions()
    """Differences that do not count."""
