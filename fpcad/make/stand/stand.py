"""The stand of one hand: its printed parts, what was found about them, and how they stand to the hand."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fpcad.errors import MakeError
from fpcad.make.gates.bodies import hand_bodies
from fpcad.make.gates.finding import Finding, Severity
from fpcad.make.mesh import mesh_of
from fpcad.make.parts.assembly import Assembly
from fpcad.make.parts.catalogue import Flange, lookup
from fpcad.make.parts.part import FIXED_LINK, Part
from fpcad.make.parts.solids import Solid
from fpcad.make.stand.bench import AROUND_MM, bench_solids
from fpcad.make.stand.clear import BoltedHand
from fpcad.make.stand.gates import GATE, check_bench, check_jig, left_out
from fpcad.make.stand.jig import jig_solid
from fpcad.make.stand.jig_place import CLEAR_MM, JigPlace, find_place
from fpcad.make.stand.scene import PoseScene, moved, pose_scene, stand_frame
from fpcad.make.trajectory import Trajectory
from fpcad.model.geometry import HandGeometry
from fpcad.spec.schema import Spec

Array = NDArray[np.float64]

BENCH, FRONT, JIG = "bench_stand", "bench_front", "jig_"
ABOVE_MM = 8.0
"""Hand and tool keep that far from the stand's plate."""


@dataclass(frozen=True)
class Stand:
    """Stand and jigs of one hand."""

    T_palm_stand: Array  # (4, 4) [mm]
    parts: tuple[Part, ...]
    """In the stand's frame."""
    scenes: Mapping[str, PoseScene]
    """Of the poses that have a jig."""
    away: Mapping[str, Array]
    """(3,) unit vectors in which the jigs are drawn away, in the stand's frame."""
    findings: tuple[Finding, ...]

    @property
    def jigs(self) -> dict[str, Part]:
        """By pose."""
        return {p.name.removeprefix(JIG): p for p in self.parts if p.name.startswith(JIG)}

    @property
    def bench(self) -> list[Part]:
        """The stand without its jigs."""
        return [part for part in self.parts if not part.name.startswith(JIG)]


def make_stand(
    spec: Spec,
    geometry: HandGeometry,
    assembly: Assembly,
    T_palm_base: Array,
    trajectories: Mapping[str, Trajectory],
) -> Stand:
    """The stand for a hand that is bolted to it at its base, and a jig for each pose that has room for one.

    Args:
        T_palm_base: (4, 4) [mm] middle of the face that is bolted, z away from the hand.
    """
    flange = lookup("flanges", Flange, spec.mount.flange)
    tried = [
        _layout(spec, geometry, assembly, stand_frame(T_palm_base @ turn), trajectories, flange)
        for turn in _turns(flange.screws)
    ]
    chosen = max(tried, key=lambda layout: (len(layout.places), layout.floor_mm))
    hand = BoltedHand(hand_bodies(assembly, geometry), geometry, chosen.T_palm_stand)
    places, jigs, of_jigs = _jigs(spec, hand, chosen)
    bench, of_bench = _bench(spec, hand, chosen, places)
    return Stand(
        T_palm_stand=chosen.T_palm_stand,
        parts=(*bench, *jigs),
        scenes={place.pose: chosen.scenes[place.pose] for place in places},
        away={place.pose: place.away for place in places},
        findings=(*of_bench, *of_jigs),
    )


def _jigs(
    spec: Spec, hand: BoltedHand, layout: _Layout
) -> tuple[list[JigPlace], list[Part], list[Finding]]:
    """The jigs that pass their gates and keep clear of the hand's parts."""
    places, jigs, found = [], [], [_nowhere(*lacking) for lacking in layout.lacking.items()]
    for place in layout.places:
        solid = jig_solid(place, spec.tool, layout.floor_mm, len(places))
        try:
            jig = _part(JIG + place.pose, solid, spec)
        except MakeError as error:  # a hand is a good one without one of its helpers
            found.append(_unmade(place.pose, error))
            continue
        told = check_jig(spec, jig, place.away, layout.scenes[place.pose].joints, hand)
        found += told
        if not left_out(told):
            places.append(place)
            jigs.append(jig)
    return places, jigs, found


def _bench(
    spec: Spec, hand: BoltedHand, layout: _Layout, places: Sequence[JigPlace]
) -> tuple[list[Part], list[Finding]]:
    """The stand with channels for all jigs."""
    flange = lookup("flanges", Flange, spec.mount.flange)
    longest, clearance = max(spec.print.bed_mm[:2]), spec.print.clearance_mm
    solids = bench_solids(places, layout.floor_mm, flange, clearance, longest)
    names = (BENCH, FRONT)[: len(solids)]
    bench = [_part(name, solid, spec) for name, solid in zip(names, solids, strict=True)]
    postures = [joints for place in places for joints in layout.scenes[place.pose].joints]
    return bench, [f for part in bench for f in check_bench(spec, part, postures, hand)]


def check_stand(
    spec: Spec, geometry: HandGeometry, assembly: Assembly, stand: Stand
) -> list[Finding]:
    """All gates of the parts that a stand has."""
    hand = BoltedHand(hand_bodies(assembly, geometry), geometry, stand.T_palm_stand)
    postures = [joints for scene in stand.scenes.values() for joints in scene.joints]
    found = [f for part in stand.bench for f in check_bench(spec, part, postures, hand)]
    for pose, jig in stand.jigs.items():
        found += check_jig(spec, jig, stand.away[pose], stand.scenes[pose].joints, hand)
    return found


@dataclass(frozen=True)
class _Layout:
    """One way to bolt the hand to its stand."""

    T_palm_stand: Array
    floor_mm: float
    scenes: Mapping[str, PoseScene]
    places: tuple[JigPlace, ...]
    lacking: Mapping[str, float]
    """Largest clearance [mm] of any jig, of the poses that get none."""


def _layout(
    spec: Spec,
    geometry: HandGeometry,
    assembly: Assembly,
    T_palm_stand: Array,
    trajectories: Mapping[str, Trajectory],
    flange: Flange,
) -> _Layout:
    scenes = {
        pose: pose_scene(spec, geometry, pose, trajectory, T_palm_stand)
        for pose, trajectory in trajectories.items()
    }
    floor = _floor(spec, scenes.values(), assembly, T_palm_stand, flange)
    half = spec.print.bed_mm[1] / 2 - AROUND_MM
    found = {pose: find_place(scene, spec.tool, floor, half) for pose, scene in scenes.items()}
    places = tuple(place for place in found.values() if isinstance(place, JigPlace))
    lacking = {pose: room for pose, room in found.items() if not isinstance(room, JigPlace)}
    return _Layout(T_palm_stand, floor, scenes, places, lacking)


def _turns(count: int) -> Iterator[Array]:
    """Turns (4, 4) about z that bring a circle of so many screws onto itself."""
    for k in range(count):
        turn = np.eye(4)
        turn[:3, :3] = Rotation.from_euler("z", 2 * np.pi * k / count).as_matrix()
        yield turn


def _floor(
    spec: Spec, scenes: Iterable[PoseScene], assembly: Assembly, T: Array, flange: Flange
) -> float:
    """Height [mm] of the plate in the stand's frame: below hand, tool and base."""
    lowest = [-flange.outer_mm / 2]
    T_stand_palm = np.linalg.inv(T)
    for scene in scenes:
        ends = np.minimum(scene.obstacles.starts, scene.obstacles.ends)[:, 2]
        lowest.append(float((ends - scene.obstacles.radii).min()))
        axis = scene.T_stand_tool
        for along in (spec.tool.back_mm, spec.tool.tip_mm):
            lowest.append(float(axis[2, 3] + along * axis[2, 0]) - 2 * spec.tool.radius_mm)
    for item in (*assembly.parts, *assembly.bought):
        if item.link == FIXED_LINK:
            for place in item.places:
                lowest.append(float(moved(T_stand_palm @ place, item.mesh.vertices)[:, 2].min()))
    return min(lowest) - ABOVE_MM


def _part(name: str, solid: Solid, spec: Spec) -> Part:
    return Part(name, FIXED_LINK, "endoskeleton", 1, solid, mesh_of(name, solid, spec.print))


def _unmade(pose: str, error: MakeError) -> Finding:
    return Finding(GATE, Severity.WARNING, JIG + pose, 0.0, 1.0, "body", f"left out: {error}")


def _nowhere(pose: str, clearance: float) -> Finding:
    text = "no jig: none stands within the print bed's width"
    if np.isfinite(clearance):
        text = f"no jig: none keeps more than {clearance:.1f} mm from the hand, {CLEAR_MM:g} mm are needed"
    return Finding(GATE, Severity.WARNING, JIG + pose, clearance, CLEAR_MM, "mm", text)
