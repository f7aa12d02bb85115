"""hand/transmission.yaml: which motor pulls which joint how far; theta_m = A q + b."""

from __future__ import annotations

import io

import numpy as np
from numpy.typing import NDArray
from ruamel.yaml import YAML

from fpcad.make.parts.dimensions import Dimensions, finger_dimensions
from fpcad.make.parts.mounting import Mounting, motor_names, mounting
from fpcad.make.parts.tendon_lengths import tendon_lengths
from fpcad.model.geometry import HandGeometry
from fpcad.model.transmission import hand_transmission
from fpcad.spec.schema import Spec
from fpcad.spec.templates import TEMPLATES

Array = NDArray[np.float64]

HEADER = """\
# Motor angles from joint angles: motor_rad = matrix * joint_rad + offset_rad.
# Joint torques from motor torques: joint_nm = transpose(matrix) * motor_nm.
# motor_travel_deg: turn of each motor over the joints' whole ranges.
# motor_places: where each motor sits in the box: row 1 at y > 0, row -1 at y < 0, numbered along x.
# spool_wrap_deg: wrap of each strand up to its knot, in the middle of the motor's travel.
# tendons: length_mm from knot to where a strand leaves the palm at zero angles, and what it is pulled
# or let out over the joints' ranges, measured along the modelled way; tube_mm of its tube, which begins
# 4.5 mm inside the palm; in_box_mm from there to the spool, on_spool_mm around it, total_mm from knot to knot.
# m1 and m2 drive the MCP differential (alike: flexion, opposed: abduction), m3 the IP joint.
"""


def transmission_yaml(spec: Spec, geometry: HandGeometry) -> str:
    """Content of the file; equal specs and hands give equal text."""
    names = TEMPLATES[spec.hand.template]
    d = finger_dimensions(spec, geometry)
    mount = mounting(spec, geometry, d)
    A = hand_transmission(spec.motors.transmission, len(names.fingers))
    document = {
        "motor_type": spec.motors.type,
        "motors": motor_names(names.fingers),
        "joints": [f"{finger}_{joint}" for finger in names.fingers for joint in names.joints],
        "matrix": (A + 0.0).tolist(),
        "offset_rad": np.zeros(len(A)).tolist(),
        "radii": spec.motors.transmission.model_dump(),
        "motor_travel_deg": _motor_travel(spec, A),
        "motor_places": _places(mount),
        "spool_wrap_deg": round(float(np.rad2deg(mount.box.spool.wrap)), 3),
        "tendons": _tendons(geometry, d, mount),
    }
    yaml = YAML(typ="safe", pure=True)
    yaml.default_flow_style = None  # lists of numbers on one line each
    yaml.width = 120
    stream = io.StringIO()
    yaml.dump(document, stream)
    return HEADER + stream.getvalue()


def _motor_travel(spec: Spec, A: Array) -> dict[str, float]:
    names = TEMPLATES[spec.hand.template]
    spans = [high - low for low, high in (spec.hand.joint_limits_deg[j] for j in names.joints)]
    travel = np.abs(A) @ np.tile(spans, len(names.fingers))
    motors = motor_names(names.fingers)
    return {name: round(float(turn), 3) for name, turn in zip(motors, travel, strict=True)}


def _tendons(
    geometry: HandGeometry, d: Dimensions, mount: Mounting
) -> list[dict[str, str | float]]:
    """Each motor's strand: its length in the hand, and from there to the knot on its spool."""
    return [
        {
            "name": tendon.strand,
            **{
                f"{key}_mm": round(float(value), 3)
                for key, value in (
                    ("length", tendon.in_hand),
                    ("shortest", tendon.shortest),
                    ("longest", tendon.longest),
                    ("tube", tendon.tube),
                    ("in_box", tendon.in_box),
                    ("on_spool", tendon.on_spool),
                    ("total", tendon.total),
                )
            },
        }
        for tendon in tendon_lengths(geometry, d, mount)
    ]


def _places(mount: Mounting) -> dict[str, dict[str, int]]:
    """Row of the box and number in it, along x of the box, of each motor."""
    found = {}
    for name in motor_names(mount.fingers):
        row = mount.slot(name).row
        own = sorted(slot.shaft[0] for slot in mount.box.slots if slot.row == row)
        found[name] = {"row": row, "number": own.index(mount.slot(name).shaft[0]) + 1}
    return found
