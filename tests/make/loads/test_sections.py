"""Sections and beams against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
import trimesh
from shapely.geometry import box

from fpcad.make.loads.sections import section_of, sections

EVERYWHERE = np.array([-99.0, -99.0]), np.array([99.0, 99.0])


def bar(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """A mesh along z, laid along x; its x and y become y and z."""
    turned = mesh.copy()
    turned.vertices = np.asarray(mesh.vertices)[:, [2, 0, 1]]
    return turned


def test_a_round_bar_bends_by_32_m_over_pi_d_cubed():
    rod = bar(trimesh.creation.cylinder(3.0, 40.0, sections=256))
    (section,) = sections(rod, [1.0], *EVERYWHERE)
    assert section.area_mm2 == pytest.approx(math.pi * 9, rel=1e-3)
    assert section.second_mm4 == pytest.approx(np.eye(2) * math.pi * 81 / 4, rel=1e-3, abs=1e-6)
    moment, pull = np.array([[7.0, 300.0, -400.0]]), np.array([[-20.0, 5.0, 6.0]])
    expected = 32 * 500.0 / (math.pi * 6.0**3) + 20.0 / (math.pi * 9)
    assert section.stress_mpa(pull, moment)[0] == pytest.approx(expected, rel=2e-3)


def test_a_tube_has_its_bore_taken_out():
    tube = bar(trimesh.creation.annulus(2.0, 4.0, 20.0, sections=256))
    (section,) = sections(tube, [0.5], *EVERYWHERE)
    assert section.second_mm4[0, 0] == pytest.approx(math.pi * (4**4 - 2**4) / 4, rel=1e-3)


def test_an_angle_bends_as_unsymmetrical_bending_says():
    """Two strips, b x t each; second moments by Steiner, stress by the general formula."""
    strips = [box(0.0, 0.0, 10.0, 1.0), box(0.0, 1.0, 1.0, 10.0)]
    section = section_of(0.0, strips)
    area, middles = np.array([10.0, 9.0]), np.array([[5.0, 0.5], [0.5, 5.5]])
    centre = area @ middles / area.sum()
    own = [np.diag([10.0**3 / 12, 10.0 / 12]), np.diag([9.0 / 12, 9.0**3 / 12])]
    second = sum(
        o + a * np.outer(m - centre, m - centre) for o, a, m in zip(own, area, middles, strict=True)
    )
    assert section.centroid[1:] == pytest.approx(centre)
    assert section.second_mm4 == pytest.approx(second)
    corner = np.array([0.0, 10.0]) - centre
    stress = corner @ np.linalg.solve(second, [0.0, 50.0])  # the moment about y stretches +z
    assert section.stress_mpa(np.zeros((1, 3)), np.array([[0.0, 50.0, 0.0]]))[0] >= abs(stress)


def test_pieces_of_another_beam_are_left_out():
    both = trimesh.creation.box((9.0, 2.0, 1.0))
    both.vertices += (0.0, 0.0, 5.0)
    below = trimesh.creation.box((9.0, 2.0, 1.0))
    below.vertices -= (0.0, 0.0, 5.0)
    both = trimesh.Trimesh(
        np.vstack([both.vertices, below.vertices]), np.vstack([both.faces, below.faces + 8])
    )
    (lower,) = sections(both, [0.3], EVERYWHERE[0], np.array([99.0, 0.0]))
    assert lower.area_mm2 == pytest.approx(2.0) and lower.centroid[2] == pytest.approx(-5.0)
    assert sections(both, [20.0], *EVERYWHERE) == []
