"""The parts of a hand as rigid bodies that its joints move."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import manifold3d
import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.spatial import KDTree

from fpcad.make.mesh import manifold_of
from fpcad.make.parts.assembly import Assembly, BoughtItem
from fpcad.make.parts.part import STILL_LINKS
from fpcad.model.geometry import HandGeometry

Array = NDArray[np.float64]

POINTS_PER_MM2 = 1.5
SPREAD_MM = 3.0
"""No point of a surface with that many random points is farther than this from the nearest one."""
SEED = 1
TOOL = "tool"


@dataclass(frozen=True)
class Body:
    """One copy of a part where it is in the hand, or the tool."""

    part: str
    link: str
    """`palm`, `mcp`, `proximal`, `distal`, `tool`, or `box` where the motors stand elsewhere."""
    finger: str | None
    """None for what belongs to the palm, and for the tool."""
    bought: bool
    solid: manifold3d.Manifold
    """In the frame of its link [mm]."""
    axis: Array
    """(2, 3) ends of a segment in the link's frame [mm]."""
    radius: float
    """The body lies within this distance [mm] of the segment."""

    @property
    def name(self) -> str:
        """The part's name, with the finger's before it."""
        return f"{self.finger} {self.part}" if self.finger else self.part

    @property
    def still(self) -> bool:
        """Whether it belongs to no finger and is not the tool: its link's frame is H."""
        return self.finger is None and self.link != TOOL

    @cached_property
    def box(self) -> Array:
        """(2, 3) least and greatest coordinates [mm] in the link's frame."""
        return np.array(self.solid.bounding_box()).reshape(2, 3)

    @cached_property
    def surface(self) -> KDTree:
        """Points spread over the surface [mm], in the link's frame; none is farther than SPREAD_MM from the next."""
        mesh = _mesh_of(self.solid)
        count = int(POINTS_PER_MM2 * mesh.area) + 50
        spread = trimesh.sample.sample_surface(mesh, count, seed=SEED)[0]
        return KDTree(np.vstack([mesh.vertices, spread]))


def body_of(
    part: str, link: str, mesh: trimesh.Trimesh, finger: str | None = None, bought: bool = False
) -> Body:
    """A mesh [mm] in its link's frame as a body."""
    axis, radius = min(_capsules(np.asarray(mesh.vertices)), key=lambda capsule: capsule[1])
    return Body(part, link, finger, bought, manifold_of(mesh), axis, radius)


def merged(bodies: Sequence[Body], name: str) -> Body:
    """All bodies of one link as one, for a first look."""
    one = body_of_solid(name, bodies[0].link, union([body.solid for body in bodies]))
    return replace(one, finger=bodies[0].finger)


def union(solids: Sequence[manifold3d.Manifold]) -> manifold3d.Manifold:
    """All solids as one; they may be apart, touch or overlap."""
    return manifold3d.Manifold.batch_boolean(list(solids), manifold3d.OpType.Add)


def body_of_solid(part: str, link: str, solid: manifold3d.Manifold) -> Body:
    """A solid [mm] in its link's frame as a body."""
    vertices = np.asarray(_mesh_of(solid).vertices)
    axis, radius = min(_capsules(vertices), key=lambda capsule: capsule[1])
    return Body(part, link, None, False, solid, axis, radius)


def _mesh_of(solid: manifold3d.Manifold) -> trimesh.Trimesh:
    raw = solid.to_mesh64()
    return trimesh.Trimesh(raw.vert_properties[:, :3], raw.tri_verts, process=False)


def hand_bodies(assembly: Assembly, geometry: HandGeometry) -> list[Body]:
    """All parts and bought items of a hand, those of a finger once for each finger."""
    bodies = []
    for item in (*assembly.parts, *assembly.bought):
        bought = isinstance(item, BoughtItem)
        fingers = (None,) if item.link in STILL_LINKS else geometry.fingers
        for place in item.places:
            mesh = item.mesh.copy().apply_transform(place)
            first = body_of(item.name, item.link, mesh, fingers[0], bought)
            bodies += [replace(first, finger=finger) for finger in fingers]
    return bodies


def body_poses(body: Body, geometry: HandGeometry, joints: Array) -> Array:
    """Poses (N, 4, 4) [mm] in H of a body's link, for joints (N, n_fingers, 3) [rad]."""
    if body.finger is None:
        return np.broadcast_to(np.eye(4), (len(joints), 4, 4))
    u = joints[:, geometry.fingers.index(body.finger)]
    return link_poses(geometry, body.finger, body.link, u)


def link_poses(geometry: HandGeometry, finger: str, link: str, u: Array) -> Array:
    """Poses (N, 4, 4) [mm] in H of a finger's link, for its own joints u (N, 3) [rad]."""
    pose = geometry.T_palm_root[finger] @ _turn(u[:, 0], 1)
    if link == "mcp":
        return pose
    pose = pose @ _turn(u[:, 1], 2)
    if link == "proximal":
        return pose
    ip = np.eye(4)
    ip[0, 3] = geometry.proximal_length_mm
    return pose @ ip @ _turn(u[:, 2], 1)


def _turn(angles: Array, axis: int) -> Array:
    """Rotations (N, 4, 4) about y (1) or z (2) by angles (N,) [rad]."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    poses = np.broadcast_to(np.eye(4), (len(angles), 4, 4)).copy()
    poses[:, i, i] = poses[:, j, j] = np.cos(angles)
    poses[:, j, i] = np.sin(angles)
    poses[:, i, j] = -poses[:, j, i]
    return poses


def _capsules(vertices: Array) -> Iterator[tuple[Array, float]]:
    """Capsules about all vertices (n, 3): along the link's axis, and along the body's own axes."""
    middle = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    own = np.linalg.svd(vertices - vertices.mean(axis=0), full_matrices=False)[2]
    for origin, direction in ((np.zeros(3), np.eye(3)[0]), *((middle, own[i]) for i in range(3))):
        along = (vertices - origin) @ direction
        radial = np.linalg.norm(vertices - origin - np.outer(along, direction), axis=1)
        # max with 0: the square of a number and of an array may differ in the last bit
        reach = np.sqrt(
            np.maximum(radial.max() ** 2 - radial**2, 0.0)
        )  # how far the balls at the ends may cover
        low, high = float((along + reach).min()), float((along - reach).max())
        if low > high:
            low = high = (low + high) / 2
        beyond = along - np.clip(along, low, high)
        axis = origin + np.outer([low, high], direction)
        yield axis, float(np.hypot(beyond, radial).max())
