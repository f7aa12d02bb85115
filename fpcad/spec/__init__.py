"""The spec of a design: what one YAML file may say, and reading it."""

from fpcad.spec.catalogue import Motor, motor, motor_types
from fpcad.spec.dump import dump_spec, spec_hash
from fpcad.spec.faults import Fault
from fpcad.spec.load import find_faults, load_spec
from fpcad.spec.new import write_new
from fpcad.spec.outline import json_schema
from fpcad.spec.schema import Spec

__all__ = [
    "Fault",
    "Motor",
    "Spec",
    "dump_spec",
    "find_faults",
    "json_schema",
    "load_spec",
    "motor",
    "motor_types",
    "spec_hash",
    "write_new",
]
