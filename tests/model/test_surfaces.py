"""Charts: points on the surface, Gauss frames, metrics and curvatures."""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca
import numpy as np
import pytest

from fpcad.model.frames import Expr, Frame, rot_axis
from fpcad.model.hand import LinkShape
from fpcad.model.surfaces import (
    SurfacePoint,
    capsule_point,
    cylinder_point,
    turned_tool,
    turning_axis,
)
from fpcad.spec.pose import Turning
from fpcad.spec.tool import CylinderTool
from tests.model.plain_hand import Array, distal_touch, tool_touch

TOOL = CylinderTool(radius_mm=6, back_mm=-80, tip_mm=80)
DISTAL = LinkShape(34.5, 8.0, True, True, False, 0.0)
PROXIMAL = LinkShape(57.5, 8.0, False, False, True, 12.0)
DESIGN = np.array([42.5, 85.0, 30.0, 16.0, 1.3, 0.0])

Chart = Callable[[float, float], SurfacePoint]
CHARTS: dict[str, tuple[Chart, tuple[float, float]]] = {
    "tool": (lambda s, phi: cylinder_point(TOOL, s, phi), (-80.0, 80.0)),
    "distal cylinder": (lambda s, phi: capsule_point(DISTAL, s, phi), (0.0, 34.4)),
    "tip": (lambda s, phi: capsule_point(DISTAL, s, phi), (34.6, 34.5 + 0.9 * 8 * np.pi / 2)),
    "proximal": (lambda s, phi: capsule_point(PROXIMAL, s, phi), (0.0, 57.5)),
}
SEEDS = range(5)


def numbers(value: Expr) -> Array:
    """An expression without symbols as an array."""
    return np.array(ca.DM(value)).squeeze()


def sample(name: str, seed: int) -> tuple[Chart, float, float]:
    """A chart with coordinates inside it."""
    chart, (low, high) = CHARTS[name]
    random = np.random.default_rng(seed)
    return chart, random.uniform(low, high), random.uniform(-2, 2)


def slopes(of: Callable[[float, float], Array], s: float, phi: float, h: float = 1e-5) -> Array:
    """Central differences along both coordinates, as columns."""
    return np.stack(
        [(of(s + h, phi) - of(s - h, phi)) / (2 * h), (of(s, phi + h) - of(s, phi - h)) / (2 * h)],
        axis=1,
    )


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", CHARTS)
class TestEveryChart:
    def test_normal_is_unit_and_crosses_the_tangents(self, name: str, seed: int):
        chart, s, phi = sample(name, seed)
        point = chart(s, phi)
        normal, (x, y) = numbers(point.normal), numbers(point.tangents).T
        assert np.linalg.norm(normal) == pytest.approx(1, abs=1e-14)
        assert np.allclose(np.abs(normal @ np.cross(x, y)), 1, atol=1e-14)
        assert np.allclose([x @ x, y @ y, x @ y], [1, 1, 0], atol=1e-14)

    def test_metric_measures_steps_along_the_tangents(self, name: str, seed: int):
        chart, s, phi = sample(name, seed)
        point = chart(s, phi)
        steps = slopes(lambda *at: numbers(chart(*at).p), s, phi)
        assert np.allclose(steps, numbers(point.tangents) * numbers(point.metric), atol=1e-8)

    def test_curvature_turns_the_normal(self, name: str, seed: int):
        """dn = E K M da, positive on a convex surface."""
        chart, s, phi = sample(name, seed)
        point = chart(s, phi)
        turns = slopes(lambda *at: numbers(chart(*at).normal), s, phi)
        promised = numbers(point.tangents) * (numbers(point.curvature) * numbers(point.metric))
        assert np.allclose(turns, promised, atol=1e-9)


@pytest.mark.parametrize("seed", SEEDS)
def test_points_lie_on_the_tool(seed: int):
    point = cylinder_point(TOOL, 12.0, float(np.random.default_rng(seed).uniform(-3, 3)))
    assert numbers(point.p)[0] == 12.0
    assert np.linalg.norm(numbers(point.p)[1:]) == pytest.approx(6, abs=1e-13)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", ["distal cylinder", "tip"])
def test_points_lie_on_the_capsule(name: str, seed: int):
    _, s, phi = sample(name, seed)
    p = numbers(capsule_point(DISTAL, s, phi).p)
    on_axis = np.array([np.clip(p[0], 0, DISTAL.axis_length), 0, 0])
    assert np.linalg.norm(p - on_axis) == pytest.approx(8, abs=1e-13)


def test_tool_angle_zero_is_along_y():
    assert np.allclose(numbers(cylinder_point(TOOL, 5, 0).p), [5, 6, 0])
    assert np.allclose(numbers(cylinder_point(TOOL, 5, np.pi / 2).p), [5, 0, 6])


def test_finger_angle_zero_is_palmar():
    assert np.allclose(numbers(capsule_point(DISTAL, 10, 0).p), [10, 0, -8])
    assert np.allclose(numbers(capsule_point(DISTAL, 10, np.pi / 2).p), [10, 8, 0])


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", ["distal cylinder", "tip"])
def test_capsule_is_that_of_plain_numpy(name: str, seed: int):
    _, s, phi = sample(name, seed)
    point, plain = capsule_point(DISTAL, s, phi), distal_touch(DESIGN, s, phi)
    for ours, theirs in zip((point.p, point.normal, point.tangents), plain, strict=True):
        assert np.allclose(numbers(ours), theirs, atol=1e-13)


def test_only_curvature_jumps_at_the_seam():
    before, after = (capsule_point(DISTAL, 34.5 + side, 0.7) for side in (-1e-9, 1e-9))
    for name in ("p", "normal", "tangents", "metric"):
        assert np.allclose(numbers(getattr(before, name)), numbers(getattr(after, name)), atol=3e-9)
    assert numbers(before.curvature).tolist() == [0, 1 / 8]
    assert numbers(after.curvature).tolist() == [1 / 8, 1 / 8]


def test_moving_a_point_keeps_metric_and_curvature():
    frame = Frame(rot_axis((1.0, 2.0, -1.0), 0.6), ca.DM([1, 2, 3]))
    point = capsule_point(DISTAL, 40, 0.4)
    moved = point.moved(frame)
    assert np.allclose(numbers(moved.p), numbers(frame.R) @ numbers(point.p) + [1, 2, 3])
    assert np.allclose(numbers(moved.normal), numbers(frame.R) @ numbers(point.normal))
    assert numbers(moved.metric).tolist() == numbers(point.metric).tolist()
    assert numbers(moved.curvature).tolist() == numbers(point.curvature).tolist()


@pytest.mark.parametrize("angle", [-2.0, 0.0, 0.3])
def test_turning_holds_the_pivot_and_the_axis(angle: float):
    turning = Turning(axis=(1.0, 1.0, 0.5), pivot_mm=(10.0, -4.0, 2.0))
    frame, axis = turned_tool(turning, angle), turning_axis(turning)
    assert np.allclose(numbers(frame.point(ca.DM([10, -4, 2]))), [10, -4, 2])
    assert np.allclose(numbers(frame.R) @ axis, axis)
    assert np.trace(numbers(frame.R)) == pytest.approx(1 + 2 * np.cos(angle))


def test_tool_turns_as_plain_numpy_says():
    plain, frame = tool_touch(0.4, 20.0, 1.1), turned_tool(Turning(), 0.4)
    point = cylinder_point(TOOL, 20.0, 1.1).moved(frame)
    for ours, theirs in zip((point.p, point.normal, point.tangents), plain, strict=True):
        assert np.allclose(numbers(ours), theirs, atol=1e-13)
