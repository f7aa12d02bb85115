"""hand/transmission.yaml: which motor pulls which joint how far; theta_m = A q + b."""

from __future__ import annotations

import io

import numpy as np
from ruamel.yaml import YAML

from fpcad.model.transmission import hand_transmission
from fpcad.spec.schema import Spec
from fpcad.spec.templates import TEMPLATES

MOTORS_PER_FINGER = ("m1", "m2", "m3")

HEADER = """\
# Motor angles from joint angles: motor_rad = matrix * joint_rad + offset_rad.
# Joint torques from motor torques: joint_nm = transpose(matrix) * motor_nm.
# m1 and m2 drive the MCP differential (alike: flexion, opposed: abduction), m3 the IP joint.
"""


def transmission_yaml(spec: Spec) -> str:
    """Content of the file; equal specs give equal text."""
    names = TEMPLATES[spec.hand.template]
    A = hand_transmission(spec.motors.transmission, len(names.fingers))
    document = {
        "motor_type": spec.motors.type,
        "motors": [f"{finger}_{motor}" for finger in names.fingers for motor in MOTORS_PER_FINGER],
        "joints": [f"{finger}_{joint}" for finger in names.fingers for joint in names.joints],
        "matrix": (A + 0.0).tolist(),
        "offset_rad": np.zeros(len(A)).tolist(),
        "radii": spec.motors.transmission.model_dump(),
    }
    yaml = YAML(typ="safe", pure=True)
    yaml.default_flow_style = None  # lists of numbers on one line each
    yaml.width = 120
    stream = io.StringIO()
    yaml.dump(document, stream)
    return HEADER + stream.getvalue()
