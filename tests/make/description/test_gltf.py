"""The hand as one GLB file."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
import yourdfpy

from tests.make.hands import CENTRE


@pytest.fixture
def scene(described) -> trimesh.Scene:
    loaded = trimesh.load(described[CENTRE] / "clay.glb")
    assert isinstance(loaded, trimesh.Scene)
    return loaded


def test_links_are_nodes_at_the_urdfs_places(scene, described):
    robot = yourdfpy.URDF.load(str(described[CENTRE] / "urdf" / "clay.urdf"), load_meshes=False)
    upright = scene.graph.get("palm")[0]
    for link in robot.link_map:
        expected = upright @ robot.get_transform(link, "palm")
        assert np.abs(scene.graph.get(link)[0] - expected).max() < 1e-6  # glTF keeps 32 bits


def test_y_points_up_where_the_hands_z_does(scene):
    assert scene.graph.get("palm")[0][:3, 2].tolist() == [0, 1, 0]


def test_it_is_a_hand_in_metres_of_dull_materials(scene):
    assert 0.1 < scene.extents.max() < 0.3
    assert len(scene.geometry) == 6
    for mesh in scene.geometry.values():
        assert mesh.visual.material.metallicFactor == 0
        assert np.abs(np.linalg.norm(mesh.vertex_normals, axis=1) - 1).max() < 1e-6
