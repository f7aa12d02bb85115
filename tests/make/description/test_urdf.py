"""The URDF says what the model says, to any reader."""

from __future__ import annotations

import itertools
import xml.etree.ElementTree as ET

import numpy as np
import pinocchio  # pyright: ignore[reportMissingImports]
import pytest
import trimesh
import yourdfpy
from scipy.spatial.transform import Rotation

from fpcad.make.description import describe
from fpcad.make.description.urdf import urdf_text
from fpcad.make.hand import link_bodies
from fpcad.make.inertia import inertia_of
from fpcad.make.parts.materials import densities
from fpcad.make.primitives import pose_along, roll_pitch_yaw
from fpcad.model.geometry import link_poses
from fpcad.spec.catalogue import motor
from tests.make.hands import CENTRE, CLAY, CORNERS, TEMPLATE, assembly_of, design, geometry_of

NAMES = TEMPLATE.names
JOINTS = [f"{finger}_{joint}" for finger in NAMES.fingers for joint in NAMES.joints]


def random_joints(seed: int) -> np.ndarray:
    limits = np.deg2rad([CLAY.hand.joint_limits_deg[joint] for joint in NAMES.joints])
    random = np.random.default_rng(seed)
    return random.uniform(limits[:, 0], limits[:, 1], (len(NAMES.fingers), len(NAMES.joints)))


def model_poses_m(values: tuple[float, ...], joints: np.ndarray) -> dict[str, np.ndarray]:
    poses = {}
    for finger, links in link_poses(TEMPLATE, design(values), joints).items():
        for link, pose in links.items():
            poses[f"{finger}_{link}"] = pose.copy()
            poses[f"{finger}_{link}"][:3, 3] *= 1e-3
    return poses


def urdf_file(clay_hand):
    return clay_hand / "hand" / "urdf" / "clay.urdf"


@pytest.mark.parametrize("seed", range(5))
def test_yourdfpy_finds_the_models_links(clay_hand, seed):
    joints = random_joints(seed)
    robot = yourdfpy.URDF.load(str(urdf_file(clay_hand)))
    robot.update_cfg(dict(zip(JOINTS, joints.reshape(-1), strict=True)))
    for link, pose in model_poses_m(CENTRE, joints).items():
        assert np.abs(robot.get_transform(link, "palm") - pose).max() <= 1e-9


def pinocchio_error(text: str, values: tuple[float, ...], joints: np.ndarray) -> float:
    model = pinocchio.buildModelFromXML(text)
    data = model.createData()
    q = np.zeros(model.nq)
    for name, angle in zip(JOINTS, joints.reshape(-1), strict=True):
        q[model.joints[model.getJointId(name)].idx_q] = angle
    pinocchio.framesForwardKinematics(model, data, q)
    return max(
        np.abs(data.oMf[model.getFrameId(link)].homogeneous - pose).max()
        for link, pose in model_poses_m(values, joints).items()
    )


@pytest.mark.parametrize("values", [CENTRE, *CORNERS, (42.5, 85, 30, 16, 90, 45)], ids=str)
def test_pinocchio_finds_the_models_links(clay_parts, values):
    bodies = link_bodies(CLAY, assembly_of(CENTRE))
    text = urdf_text(describe(CLAY, geometry_of(values), bodies, {}))
    for seed in range(5):
        assert pinocchio_error(text, values, random_joints(seed)) <= 1e-9


def test_limits_are_the_specs_and_the_motors(clay_hand):
    row = motor(CLAY.motors.type)
    robot = yourdfpy.URDF.load(str(urdf_file(clay_hand)), load_meshes=False)
    for name, torque in (("mcp_flex", 2.0), ("mcp_abd", 24 / 13), ("ip_flex", 8 / 13)):
        limit = robot.joint_map[f"ring_{name}"].limit
        assert np.rad2deg([limit.lower, limit.upper]) == pytest.approx(
            CLAY.hand.joint_limits_deg[name]
        )
        assert limit.effort == pytest.approx(torque * row.continuous_torque_nm)
    assert limit.velocity == pytest.approx(13 / 8 * row.no_load_speed_rad_s)


def test_inertias_belong_to_real_bodies(clay_hand):
    model = pinocchio.buildModelFromUrdf(str(urdf_file(clay_hand)))
    assert len(model.inertias) == 13
    for body in model.inertias[1:]:  # the first stands for the fixed palm
        moments = np.linalg.eigvalsh(body.inertia)
        assert body.mass > 0 and moments[0] > 0
        assert moments[2] < moments[0] + moments[1]


def test_inertia_of_two_halves_is_that_of_the_whole():
    whole = trimesh.creation.box((30, 20, 10))
    halves = [trimesh.creation.box((15, 20, 10)).apply_translation((x, 0, 0)) for x in (-7.5, 7.5)]
    found = inertia_of((half, 1.2) for half in halves)
    mass = 30 * 20 * 10 * 1.2e-6
    expected = mass / 12 * np.array([20**2 + 10**2, 30**2 + 10**2, 30**2 + 20**2]) * 1e-6
    assert found.mass_kg == pytest.approx(mass)
    assert np.allclose(found.tensor_kgm2, np.diag(expected), rtol=1e-9, atol=1e-18)
    assert np.allclose(found.tensor_kgm2, inertia_of([(whole, 1.2)]).tensor_kgm2, atol=1e-18)


def test_collision_shapes_are_primitives(clay_hand):
    robot = ET.parse(urdf_file(clay_hand)).getroot()
    shapes = {
        link.get("name"): [shape.tag for shape in link.findall("collision/geometry/*")]
        for link in robot.findall("link")
    }
    assert sorted(shapes["palm"]) == ["box"] * 2 + ["cylinder"] * 4 + ["sphere"] * 8
    for finger, link in itertools.product(NAMES.fingers, NAMES.links):
        assert sorted(shapes[f"{finger}_{link}"]) == ["cylinder", "sphere", "sphere"]


def test_meshes_lie_where_the_urdf_says(clay_hand):
    urdf = urdf_file(clay_hand)
    for mesh in ET.parse(urdf).getroot().iter("mesh"):
        visual = trimesh.load_mesh(urdf.parent / mesh.get("filename"))
        assert visual.is_watertight and 0.005 < visual.extents.max() < 0.3


@pytest.mark.parametrize("pitch", [-90, -89.9999999, 0, 30, 89.99999, 90, 120])
def test_angles_give_the_rotation_back(pitch):
    roll, yaw = 0.7, -2.1
    R = Rotation.from_euler("ZYX", [yaw, np.deg2rad(pitch), roll]).as_matrix()
    angles = roll_pitch_yaw(R)
    assert np.allclose(Rotation.from_euler("xyz", angles).as_matrix(), R, atol=1e-12)


def test_pose_along_points_its_z():
    axis = np.array([0.6, 0.0, -0.8])
    pose = pose_along(np.zeros(3), axis)
    assert np.allclose(pose[:3, 2], axis)
    assert np.isclose(np.linalg.det(pose[:3, :3]), 1.0)


def test_the_palm_weighs_what_is_fixed_to_it(clay_hand):
    palm = ET.parse(urdf_file(clay_hand)).getroot().find("link[@name='palm']/inertial/mass")
    assert palm is not None
    density = densities(CLAY.print)
    made = assembly_of(CENTRE)
    grams = sum(
        part.count * part.mesh.volume * 1e-3 * density[part.material]
        for part in made.parts
        if part.link == "palm"
    )
    grams += sum(item.count * item.mass_g for item in made.bought if item.link == "palm")
    assert grams > 12 * motor(CLAY.motors.type).mass_g
    assert float(palm.get("value", "nan")) == pytest.approx(grams * 1e-3, rel=1e-6)
