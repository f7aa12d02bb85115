"""What the hand is mounted on: flange, tubes and the motors' box, put together once for all that need it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fpcad.errors import MakeError
from fpcad.make.parts.bought import BoughtItem
from fpcad.make.parts.catalogue import Tube, lookup
from fpcad.make.parts.curves import swept
from fpcad.make.parts.dimensions import Dimensions
from fpcad.make.parts.flange import flange_items
from fpcad.make.parts.flange_dimensions import FlangeDimensions, flange_dimensions
from fpcad.make.parts.motor_box import box_parts
from fpcad.make.parts.motor_box_dimensions import (
    FLANGE_CIRCLE_MM,
    MotorBox,
    MotorSlot,
    motor_box_dimensions,
)
from fpcad.make.parts.motor_box_items import box_items
from fpcad.make.parts.part import BOX_LINK, FIXED_LINK, Array, Part
from fpcad.make.parts.routing import TUBE
from fpcad.make.parts.tube_routes import (
    MOTORS,
    TubeRoute,
    TubeRoutes,
    loose_routes,
    tube_routes,
)
from fpcad.model.geometry import HandGeometry
from fpcad.spec.schema import Spec

PTFE_G_MM3 = 2.2e-3
ASIDE_MM = 200.0
"""A box that stands elsewhere is drawn so far behind the flange."""


@dataclass(frozen=True)
class Mounting:
    """Flange, box and tubes of one hand."""

    spec: Spec
    fingers: tuple[str, ...]
    flange: FlangeDimensions
    box: MotorBox
    tubes: TubeRoutes

    @property
    def box_link(self) -> str:
        """The link that the box is fixed to: the palm's, or none of the robot's."""
        return FIXED_LINK if self.spec.mount.box else BOX_LINK

    @property
    def T_palm_base(self) -> Array:
        """Pose (4, 4) [mm] in H of the face that a robot or a stand takes, z away from the hand."""
        if not self.spec.mount.box:
            return self.flange.T_palm_flange
        back = np.eye(4)
        back[2, 3] = self.box.size[2]
        return self.tubes.T_palm_box @ back

    def slot(self, motor: str) -> MotorSlot:
        """The place in the box of a motor such as `index_m1`."""
        return self.box.slots[self.tubes.slots[motor]]

    @cached_property
    def route(self) -> dict[str, TubeRoute]:
        """The tube of each strand, by `index_m1_flexor` and so on."""
        return {route.strand: route for route in self.tubes.routes}

    def parts(self) -> list[Part]:
        """The box's printed parts; the flange is made with the palm."""
        made = box_parts(self.spec, len(self.fingers), self.tubes.T_palm_box)
        return [replace(part, link=self.box_link) for part in made]

    def items(self) -> tuple[BoughtItem, ...]:
        """What is bought for flange, box and tubes."""
        boxed = box_items(self.spec, len(self.fingers), self.tubes.T_palm_box)
        in_box = (replace(item, link=self.box_link) for item in boxed)
        return (*flange_items(self.flange), *in_box, *map(_tube, self.tubes.routes))


def mounting(spec: Spec, geometry: HandGeometry, d: Dimensions) -> Mounting:
    """The mounting of a hand; raises :class:`MakeError` with figures where it has no room."""
    flange, box = flange_and_box(spec, geometry, d)
    if spec.mount.box:
        tubes = tube_routes(geometry, d, flange, box)
    else:
        tubes = _aside(geometry, d, flange, spec.mount.tube_mm)
    return Mounting(spec, geometry.fingers, flange, box, tubes)


def flange_and_box(
    spec: Spec, geometry: HandGeometry, d: Dimensions
) -> tuple[FlangeDimensions, MotorBox]:
    """Lengths of both, in some milliseconds; raises :class:`MakeError` with figures."""
    box = motor_box_dimensions(spec, len(geometry.fingers))
    flange = flange_dimensions(spec.mount, geometry, d, box.flange_screw_z[0])
    if spec.mount.box and not math.isclose(flange.flange.circle_mm, FLANGE_CIRCLE_MM):
        raise MakeError(
            f"mount.flange: the motors' box takes a circle of {FLANGE_CIRCLE_MM:g} mm, "
            f"{flange.flange.size} has {flange.flange.circle_mm:g} mm"
        )
    return flange, box


def _aside(
    geometry: HandGeometry, d: Dimensions, flange: FlangeDimensions, tube_mm: float
) -> TubeRoutes:
    """Motors in the order of their numbers, in a box that is drawn behind the flange."""
    away = np.eye(4)
    away[2, 3] = ASIDE_MM
    names = motor_names(geometry.fingers)
    slots = {name: number for number, name in enumerate(names)}
    routes = loose_routes(geometry, d, tube_mm)
    return TubeRoutes(flange.T_palm_flange @ away, slots, routes)


def motor_names(fingers: Sequence[str]) -> list[str]:
    """`thumb_m1` and so on, in the order of the transmission."""
    return [f"{finger}_{motor}" for finger in fingers for motor in MOTORS]


def _tube(route: TubeRoute) -> BoughtItem:
    """One tube, cut to length; of a loose one, all its mass counts where it begins."""
    row = lookup("tubes", Tube, TUBE)
    mesh = swept(route.points, row.outer_mm / 2)
    section = math.pi / 4 * (row.outer_mm**2 - row.inner_mm**2)
    length = round(route.length_mm, 1)
    mass = section * length * PTFE_G_MM3
    here: tuple[Array, ...] = (np.eye(4),)
    return BoughtItem(
        f"tube_{route.strand}", "tubes", row.size, FIXED_LINK, here, 1, mass, mesh, length
    )
