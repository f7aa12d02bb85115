"""A jig is one body wherever it stands, and a hand does not depend on it."""

from __future__ import annotations

import numpy as np
import pytest

from fpcad.make.gates.finding import Severity
from fpcad.make.parts.assembly import Assembly
from fpcad.make.parts.dimensions import finger_dimensions
from fpcad.make.parts.mounting import mounting
from fpcad.make.stand import stand as stands
from fpcad.make.stand.gates import GATE
from fpcad.make.stand.jig import jig_solid
from fpcad.make.stand.jig_place import JigPlace
from tests.make.hands import CENTRE, CLAY, geometry_of
from tests.make.simple_hand import nod

FLOOR_MM = -80.90747955480188


AXIS = (-0.37165199395768767, 0.71311392242813465, -0.59442689123763182)
ORIGIN_MM = (247.69751438585547, 7.6399281542163280, 17.566708424139751)
AWAY = (0.9848077530122081, 0.17364817766693014, 0.0)
"""Of a jig whose spine the kernel lost; another last digit, and it was there."""


def place_of(away: tuple[float, float, float]) -> JigPlace:
    """With the tool as it lay there."""
    T = np.eye(4)
    T[:3, 0], T[:3, 3] = AXIS, ORIGIN_MM
    return JigPlace("askew", np.array(away), (-74.0, -44.0), -84.0, T, 7.0)


@pytest.mark.parametrize("away", [AWAY, (1.0, 0.0, 0.0)])
def test_a_jig_is_one_valid_body(away):
    solid = jig_solid(place_of(away), CLAY.tool, FLOOR_MM, 0)
    assert solid.isValid() and len(solid.Solids()) == 1


def test_a_jig_that_cannot_be_modelled_is_left_out_with_a_warning(monkeypatch):
    """The hand is made all the same, and has its stand."""
    apart = jig_solid(place_of(AWAY), CLAY.tool, FLOOR_MM, 0)
    apart = apart.fuse(apart.translate((500.0, 0.0, 0.0)))
    monkeypatch.setattr(stands, "jig_solid", lambda *_: apart)
    geometry = geometry_of(CENTRE)
    base = mounting(CLAY, geometry, finger_dimensions(CLAY, geometry)).T_palm_base
    stand = stands.make_stand(CLAY, geometry, Assembly((), ()), base, {"nod": nod()})
    (told,) = [f for f in stand.findings if f.gate == GATE]
    assert told.severity is Severity.WARNING and told.part == "jig_nod"
    assert "left out: part jig_nod" in told.text and "2 bodies" in told.text
    assert stand.jigs == {} and stand.bench
