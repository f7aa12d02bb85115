"""Gate: tubes keep clear of flange and stem, and are not bent tightly. They give way, so they only warn."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from scipy.spatial import KDTree

from fpcad.make.gates.finding import Finding, Severity, point
from fpcad.make.parts.catalogue import Tube, lookup
from fpcad.make.parts.curves import dense
from fpcad.make.parts.dimensions import finger_dimensions
from fpcad.make.parts.mounting import Mounting, mounting
from fpcad.make.parts.routing import TUBE
from fpcad.make.parts.tube_routes import flange_gap
from fpcad.model.geometry import HandGeometry
from fpcad.spec.schema import Spec

GATE = "tubes"
LEAST_BEND_MM = 15.0
"""A tube of 1 x 2 mm kinks below some 10 mm; friction grows before."""
LEAST_GAP_MM = 0.5


def check_tubes(spec: Spec, geometry: HandGeometry) -> list[Finding]:
    """Least bend radius, least gap to the flange, least gap between two tubes."""
    mount = mounting(spec, geometry, finger_dimensions(spec, geometry))
    if not spec.mount.box:
        return []
    return [_bend(mount), _flange(mount), _crossing(mount)]


def _bend(mount: Mounting) -> Finding:
    route = min(mount.tubes.routes, key=lambda route: route.bend_mm)
    tight = route.bend_mm < LEAST_BEND_MM
    longest = max(own.length_mm for own in mount.tubes.routes)
    whole = sum(own.length_mm for own in mount.tubes.routes)
    text = (
        f"bent to a radius of {route.bend_mm:.1f} mm, at least {LEAST_BEND_MM:g} mm is wanted; "
        f"the tubes take {whole:.0f} mm, the longest {longest:.0f} mm"
    )
    text += "; a longer mount.stem_mm helps" if tight else ""
    severity = Severity.WARNING if tight else Severity.FIGURE
    name = f"tube {route.strand}"
    return Finding(GATE, severity, name, route.bend_mm, LEAST_BEND_MM, "mm", text)


def _flange(mount: Mounting) -> Finding:
    radius = lookup("tubes", Tube, TUBE).outer_mm / 2
    gaps = [flange_gap(mount.flange, route.points) - radius for route in mount.tubes.routes]
    number = int(np.argmin([gap.min() for gap in gaps]))
    route, gap = mount.tubes.routes[number], gaps[number]
    least = float(gap.min())
    severity = Severity.WARNING if least < LEAST_GAP_MM else Severity.FIGURE
    where = point(route.points[int(gap.argmin())])
    name = f"tube {route.strand}"
    text = f"{least:.1f} mm from the flange"
    return Finding(GATE, severity, name, least, LEAST_GAP_MM, "mm", text, where)


def _crossing(mount: Mounting) -> Finding:
    """Two tubes at their nearest; they may touch, and then one goes around the other."""
    width = lookup("tubes", Tube, TUBE).outer_mm
    lines = [dense(route.points) for route in mount.tubes.routes]
    trees = [KDTree(line) for line in lines]
    least, pair, where = np.inf, (0, 0), lines[0][0]
    for i, j in combinations(range(len(lines)), 2):
        apart, _ = trees[i].query(lines[j])
        k = int(apart.argmin())
        if apart[k] < least:
            least, pair, where = float(apart[k]), (i, j), lines[j][k]
    first, second = (mount.tubes.routes[n].strand for n in pair)
    gap = least - width
    text = f"{gap:.1f} mm between them as drawn" + (
        "; lead one around the other" if gap < 0 else ""
    )
    return Finding(
        GATE, Severity.FIGURE, f"tubes {first} and {second}", gap, 0.0, "mm", text, point(where)
    )
