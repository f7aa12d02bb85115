"""hand/transmission.yaml: which motor pulls which joint how far; theta_m = A q + b."""

from __future__ import annotations

import io
import itertools

import numpy as np
from numpy.typing import NDArray
from ruamel.yaml import YAML

from fpcad.make.parts.dimensions import finger_dimensions
from fpcad.make.parts.tendon_paths import FingerTendons
from fpcad.model.geometry import HandGeometry
from fpcad.model.transmission import hand_transmission
from fpcad.spec.schema import Spec
from fpcad.spec.templates import TEMPLATES

Array = NDArray[np.float64]

MOTORS_PER_FINGER = ("m1", "m2", "m3")

HEADER = """\
# Motor angles from joint angles: motor_rad = matrix * joint_rad + offset_rad.
# Joint torques from motor torques: joint_nm = transpose(matrix) * motor_nm.
# motor_travel_deg: turn of each motor over the joints' whole ranges.
# tendons: length_mm from knot to where a strand leaves the palm at zero angles, and what it is pulled
# or let out over the joints' ranges, measured along the modelled way; tubes and spool come on top.
# m1 and m2 drive the MCP differential (alike: flexion, opposed: abduction), m3 the IP joint.
"""


def transmission_yaml(spec: Spec, geometry: HandGeometry) -> str:
    """Content of the file; equal specs and hands give equal text."""
    names = TEMPLATES[spec.hand.template]
    A = hand_transmission(spec.motors.transmission, len(names.fingers))
    document = {
        "motor_type": spec.motors.type,
        "motors": [f"{finger}_{motor}" for finger in names.fingers for motor in MOTORS_PER_FINGER],
        "joints": [f"{finger}_{joint}" for finger in names.fingers for joint in names.joints],
        "matrix": (A + 0.0).tolist(),
        "offset_rad": np.zeros(len(A)).tolist(),
        "radii": spec.motors.transmission.model_dump(),
        "motor_travel_deg": _motor_travel(spec, A),
        "tendons": _tendons(spec, geometry),
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
    motors = [f"{finger}_{motor}" for finger in names.fingers for motor in MOTORS_PER_FINGER]
    return {name: round(float(turn), 3) for name, turn in zip(motors, travel, strict=True)}


def _tendons(spec: Spec, geometry: HandGeometry) -> list[dict[str, str | float]]:
    """Each motor's strand: its length at zero, its shortest and longest, from the parts' dimensions."""
    d = finger_dimensions(spec, geometry)
    corners = np.array(list(itertools.product(d.mcp_flex, d.mcp_abd, d.ip_flex)))
    found = []
    for finger in geometry.fingers:
        tendons = FingerTendons(d, geometry.T_palm_root[finger])
        rest = tendons.motor_strands(np.zeros(3))
        moved = [tendons.motor_strands(joints) for joints in corners]
        for name, length in rest.items():
            lengths = [lengths[name] for lengths in moved]
            found.append(
                {
                    "name": f"{finger}_{name}",
                    "length_mm": round(length, 3),
                    "shortest_mm": round(min(lengths), 3),
                    "longest_mm": round(max(lengths), 3),
                }
            )
    return found
