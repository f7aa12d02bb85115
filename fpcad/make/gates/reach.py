"""Gate: how far each finger moves before it meets the palm or a finger at rest.

Every other finger rests while one moves. From the rest posture flexion is walked to both sides, and
from some of its angles abduction and IP bending, all in steps of two degrees at most.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fpcad.make.gates.bodies import Body, body_of_solid, body_poses, link_poses, merged, union
from fpcad.make.gates.bounds import box_gap, surface_distance, swept_box
from fpcad.make.gates.finding import Finding, Point, Severity, point
from fpcad.make.gates.joints import joint_grid
from fpcad.make.gates.meeting import LEAST_SEARCH_MM, meet, nearby
from fpcad.model.geometry import HandGeometry
from fpcad.spec.hand import Hand
from fpcad.spec.templates import TEMPLATES
from fpcad.units import DEG_PER_RAD, RAD_PER_DEG

Array = NDArray[np.float64]

GATE = "reach"
FLEX, ABD, IP = 0, 1, 2
SOME = 10
"""At every tenth angle of flexion, which is every 20 deg, the other joints are walked."""


@dataclass(frozen=True)
class Contact:
    """Where a finger first meets something."""

    pair: str
    volume_mm3: float
    at_mm: Point


def check_reach(
    bodies: Sequence[Body], geometry: HandGeometry, hand: Hand, finger: str, every: int = SOME
) -> list[Finding]:
    """What stops a finger inside its joints' limits: told as warnings, one for each obstacle.

    Args:
        every: at each so-many-th angle of flexion the other joints are walked; 1 walks whole planes.
    """
    sweep = Sweep(bodies, geometry, hand, finger)
    free, total, stops = 0, 0, dict[str, tuple[Array, Contact]]()
    for joint in (ABD, IP):
        walk = sweep.walk(joint, every)
        free, total = free + walk.free, total + walk.total
        for posture, contact in walk.ends:
            nearer = stops.get(contact.pair)
            if nearer is None or np.abs(posture).sum() < np.abs(nearer[0]).sum():
                stops[contact.pair] = posture, contact
    share = 100.0 * free / total
    text = f"{share:.0f} % of flexion x abduction and flexion x IP can be reached from rest"
    found = [Finding(GATE, Severity.FIGURE, finger, share, 100.0, "%", text)]
    for pair, (posture, contact) in stops.items():
        angles = posture * DEG_PER_RAD
        text = "they meet from flexion {:.0f}, abduction {:.0f}, IP {:.0f} deg on".format(*angles)
        value, where = float(np.abs(angles).sum()), contact.at_mm
        found.append(Finding(GATE, Severity.WARNING, pair, value, 0.0, "deg", text, where))
    return found


class Walk(NamedTuple):
    """Postures of a sweep."""

    free: int
    total: int
    ends: list[tuple[Array, Contact]]
    """Where a line ended, and with what."""


class Sweep:
    """One finger among obstacles that stand still."""

    def __init__(
        self, bodies: Sequence[Body], geometry: HandGeometry, hand: Hand, finger: str
    ) -> None:
        joints = TEMPLATES[hand.template].joints
        self.geometry, self.finger = geometry, finger
        self.grids = [joint_grid(hand, joint) for joint in joints]
        self.rest = np.array([hand.rest_posture_deg[joint] * RAD_PER_DEG for joint in joints])
        own = [body for body in bodies if body.finger == finger and body.link != "mcp"]
        links = sorted({body.link for body in own})
        self._moving = [merged([b for b in own if b.link == link], link) for link in links]
        self._own = own
        u = np.stack(np.meshgrid(*self.grids, indexing="ij"), axis=-1).reshape(-1, 3)
        self._swept = [swept_box(b, link_poses(geometry, finger, b.link, u)) for b in self._moving]
        at_rest = np.tile(self.rest, (1, len(geometry.fingers), 1))
        others = [(b, body_poses(b, geometry, at_rest)) for b in bodies if b.finger != finger]
        near = [(b, T[0]) for b, T in others if self._in_reach(swept_box(b, T))]
        self._still, self._T_still = [b for b, _ in near], [T for _, T in near]
        placed = [b.solid.transform(T[:3]) for b, T in near]
        self._obstacle = body_of_solid("obstacles", "palm", union(placed))

    def _in_reach(self, box: Array) -> bool:
        """Whether the finger's links may come to a box (2, 3) [mm] at any angles of its joints."""
        return any(box_gap(box, swept) <= 0 for swept in self._swept)

    def walk(self, joint: int, every: int) -> Walk:
        """Flexion to both sides of rest, and another joint from each so-many-th of its free angles."""
        flexion, other = self.grids[FLEX], self.grids[joint]
        i0, j0 = (int(np.argmin(np.abs(self.grids[i] - self.rest[i]))) for i in (FLEX, joint))
        rows = np.flatnonzero((np.arange(len(flexion)) - i0) % every == 0)
        postures = np.tile(self.rest, (len(flexion), len(other), 1))
        postures[..., FLEX], postures[..., joint] = flexion[:, None], other[None, :]
        trunk, branches = self._judge(postures[:, [j0]]), self._judge(postures[rows])
        free, ends = _free_run(len(flexion), i0, lambda i: trunk(i, 0))
        walked, met = 0, [(postures[i, j0], contact) for i, contact in ends]
        for place, i in enumerate(rows):
            if i in free:
                run, ends = _free_run(len(other), j0, lambda j, place=place: branches(place, j))
                walked += len(run)
                met += [(postures[i, j], contact) for j, contact in ends]
        return Walk(walked, len(rows) * len(other), met)

    def _judge(self, postures: Array) -> Callable[[int, int], Contact | None]:
        """A function that tells what the finger meets at a posture of a grid (n, m, 3)."""
        m = postures.shape[1]
        u, T_still = postures.reshape(-1, 3), np.eye(4)
        poses = [link_poses(self.geometry, self.finger, link.link, u) for link in self._moving]
        near = [
            surface_distance(self._obstacle, link, T) <= 0
            for link, T in zip(self._moving, poses, strict=True)
        ]
        pieces = {
            link.link: nearby(self._obstacle, link, T[flags], LEAST_SEARCH_MM)
            for link, T, flags in zip(self._moving, poses, near, strict=True)
        }

        known: dict[bytes, Contact | None] = {}

        def judge_link(link: Body, T: Array) -> Contact | None:
            place = T.tobytes() + link.link.encode()  # a link passes most places many times
            if place not in known:
                _, shared = meet(pieces[link.link], T_still, link, T, LEAST_SEARCH_MM)
                known[place] = None if shared is None else self._which(link.link, T)
            return known[place]

        def judge(i: int, j: int) -> Contact | None:
            k = i * m + j
            close = [
                (a, T[k]) for a, T, flags in zip(self._moving, poses, near, strict=True) if flags[k]
            ]
            return next((met for a, T in close if (met := judge_link(a, T)) is not None), None)

        return judge

    def _which(self, link: str, T_link: Array) -> Contact:
        """The pair of parts that share most."""
        found = []
        for b in self._own:
            for a, T_a in zip(self._still, self._T_still, strict=True):
                if b.link == link:
                    _, shared = meet(a, T_a, b, T_link, LEAST_SEARCH_MM)
                    if shared is not None:
                        at = point(shared.at_mm)
                        found.append(Contact(f"{a.name} and {b.name}", shared.volume_mm3, at))
        return max(found, key=lambda contact: contact.volume_mm3)


def _free_run(
    count: int, start: int, judge: Callable[[int], Contact | None]
) -> tuple[list[int], list[tuple[int, Contact]]]:
    """Numbers from `start` to both sides as far as nothing is met, and what is met beyond."""
    free, met = [], []
    sides: tuple[Iterable[int], Iterable[int]] = range(start, count), range(start - 1, -1, -1)
    for side in sides:
        for number in side:
            contact = judge(number)
            if contact is not None:
                met.append((number, contact))
                break
            free.append(number)
        if start not in free:
            break
    return free, met
