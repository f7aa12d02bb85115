"""Parts that move against each other never meet."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
import trimesh

from fpcad.errors import FpcadError
from fpcad.make.hand import rest_pairs
from fpcad.make.mesh import INTERFERENCE_MM3, check_apart, common_volume_mm3
from fpcad.make.reach import flexion_reach, mcp_pose
from fpcad.units import RAD_PER_DEG
from tests.make.hands import CENTRE, CLAY, CORNERS, geometry_of, parts_of

STEEP = CORNERS[2]
LIMITS = {
    joint: (low * RAD_PER_DEG, high * RAD_PER_DEG)
    for joint, (low, high) in CLAY.hand.joint_limits_deg.items()
}


def apart(a: trimesh.Trimesh, b: trimesh.Trimesh) -> bool:
    return common_volume_mm3(a, b) <= INTERFERENCE_MM3


def moved(mesh: trimesh.Trimesh, pose: np.ndarray) -> trimesh.Trimesh:
    return mesh.copy().apply_transform(pose)


def rotation_y(angle: float, x: float = 0.0) -> np.ndarray:
    pose = mcp_pose(angle, 0.0)
    pose[0, 3] = x
    return pose


def test_no_two_parts_of_the_straight_hand_meet(clay_parts):
    geometry = geometry_of(CENTRE)
    placed = [("palm", clay_parts["palm"].mesh)]
    for finger in geometry.fingers:
        for name, part in clay_parts.items():
            if name != "palm":
                x = geometry.proximal_length_mm if part.link == "distal" else 0.0
                pose = geometry.T_palm_root[finger] @ rotation_y(0.0, x)
                placed.append((f"{finger} {name}", moved(part.mesh, pose)))
    check_apart((*a, *b) for a, b in itertools.combinations(placed, 2))


@pytest.mark.parametrize("degrees", range(0, 111, 10))
def test_ip_joint_bends_freely(clay_parts, degrees):
    pose = rotation_y(np.deg2rad(degrees), geometry_of(CENTRE).proximal_length_mm)
    for distal in ("distal_bone", "distal_skin"):
        turned = moved(clay_parts[distal].mesh, pose)
        for proximal in ("proximal_bone", "proximal_skin"):
            assert apart(clay_parts[proximal].mesh, turned), (distal, proximal)


@pytest.mark.parametrize("finger", ["thumb", "middle", "ring"])
def test_mcp_joint_moves_freely(clay_parts, finger):
    root = geometry_of(CENTRE).T_palm_root[finger]
    palm = moved(clay_parts["palm"].mesh, np.linalg.inv(root))
    meshes = {name: part.mesh for name, part in clay_parts.items()}
    for flexion in np.linspace(*LIMITS["mcp_flex"], 6):
        cross = moved(meshes["mcp_cross"], rotation_y(flexion))
        assert apart(palm, cross)
        for abduction in (LIMITS["mcp_abd"][0], 0.0, LIMITS["mcp_abd"][1]):
            pose = mcp_pose(flexion, abduction)
            bone, skin = (moved(meshes[f"proximal_{kind}"], pose) for kind in ("bone", "skin"))
            assert apart(palm, bone) and apart(palm, skin) and apart(cross, bone)


@pytest.mark.parametrize("values", CORNERS, ids=str)
def test_corners_do_not_interfere_at_rest(values):
    check_apart(rest_pairs(parts_of(values), geometry_of(values)))


def test_clays_fingers_flex_over_their_whole_range(clay_parts):
    reach = flexion_reach(list(clay_parts.values()), geometry_of(CENTRE), LIMITS["mcp_flex"])
    for low, high in reach.values():
        assert (low, high) == pytest.approx(LIMITS["mcp_flex"])


def test_the_palm_stops_a_finger_that_curls_into_it():
    geometry = geometry_of(STEEP)
    low, high = flexion_reach(parts_of(STEEP), geometry, LIMITS["mcp_flex"])["middle"]
    assert low == pytest.approx(LIMITS["mcp_flex"][0])
    assert 0 < high < LIMITS["mcp_flex"][1]


def test_interference_names_both_parts():
    cube = trimesh.creation.box((2, 2, 2))
    with pytest.raises(FpcadError, match="parts left and right interfere"):
        check_apart([("left", cube, "right", moved(cube, rotation_y(0.0, 1.0)))])


def test_faces_that_touch_do_not_interfere():
    cube = trimesh.creation.box((2, 2, 2))
    check_apart([("left", cube, "right", moved(cube, rotation_y(0.0, 2.0)))])
