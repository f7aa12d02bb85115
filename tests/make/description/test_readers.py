"""Readers that others wrote load every hand and agree on it."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from tests.make.description.readers import Mujoco, Pinocchio, Yourdfpy
from tests.make.hands import CENTRE, CLAY, CORNERS
from tests.make.simple_hand import JOINTS, NAMES

POSTURES = 100
HANDS = pytest.mark.parametrize("values", [CENTRE, *CORNERS], ids=str)


def postures() -> Iterator[dict[str, float]]:
    """Random angles within the limits."""
    random = np.random.default_rng(6)
    limits = np.radians([CLAY.hand.joint_limits_deg[j] for j in NAMES.joints] * len(NAMES.fingers))
    for row in random.uniform(limits[:, 0], limits[:, 1], (POSTURES, len(JOINTS))):
        yield dict(zip(JOINTS, row, strict=True))


def readers(hand: Path) -> dict[str, Yourdfpy | Pinocchio | Mujoco]:
    urdf, mjcf = hand / "urdf" / "clay.urdf", hand / "mjcf" / "clay.xml"
    return {
        "yourdfpy": Yourdfpy(urdf),
        "pinocchio": Pinocchio(urdf),
        "MuJoCo's URDF reader": Mujoco(urdf),
        "MuJoCo": Mujoco(mjcf),
    }


@HANDS
def test_all_find_the_same_links_at_the_same_places(described, values):
    first, *others = readers(described[values]).values()
    for joints in postures():
        expected = first.poses(joints)
        assert len(expected) == 13
        for other in others:
            found = other.poses(joints)
            assert found.keys() == expected.keys()
            for link, pose in expected.items():
                assert np.abs(found[link] - pose).max() <= 1e-9, (type(other).__name__, link)


@HANDS
def test_all_weigh_the_hand_alike(described, values):
    masses = [reader.mass for reader in readers(described[values]).values()]
    assert np.ptp(masses) <= 1e-6 * min(masses)


@HANDS
def test_joint_space_inertias_agree(described, values):
    pinocchio = Pinocchio(described[values] / "urdf" / "clay.urdf")
    mujoco = Mujoco(described[values] / "mjcf" / "clay.xml")
    for joints in postures():
        expected, found = pinocchio.inertia(joints), mujoco.inertia(joints)
        assert np.abs(found - expected).max() <= 1e-6 * np.abs(expected).max()
        blocks = expected.reshape(4, 3, 4, 3)[range(4), :, range(4)]
        for own, other in zip(
            blocks, found.reshape(4, 3, 4, 3)[range(4), :, range(4)], strict=True
        ):
            scale = np.sqrt(np.outer(np.diag(own), np.diag(own)))  # of each entry's own joints
            assert np.abs((other - own) / scale).max() <= 1e-6


@HANDS
def test_check_urdf_finds_no_fault(described, values):
    """`check_urdf` comes with pinocchio's wheels."""
    program = Path(sys.executable).parent / "check_urdf"
    if not program.exists():
        pytest.skip(f"no {program}")
    done = subprocess.run(
        [program, described[values] / "urdf" / "clay.urdf"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert "root Link: palm has 4 child(ren)" in done.stdout
