"""Resolved specs as YAML, and their hashes."""

from __future__ import annotations

import hashlib
import io
import json
from typing import Any

from ruamel.yaml import YAML

from fpcad.spec.schema import Spec


def dump_spec(spec: Spec) -> str:
    """YAML of a spec with all defaults filled in; reading it back gives an equal spec."""
    yaml = YAML(typ="safe", pure=True)
    yaml.default_flow_style = None  # short lists and mappings in one line
    yaml.sort_base_mapping_type_on_output = False  # type: ignore[assignment]
    yaml.width = 100
    yaml.allow_unicode = True
    stream = io.StringIO()
    yaml.dump(spec.model_dump(mode="json", exclude_none=True), stream)
    return stream.getvalue()


def spec_hash(spec: Spec, *sections: str) -> str:
    """SHA-256 (hex) of the named top-level sections, of all when none is named.

    Defaults count as if they were written, and the order of keys does not count; the order of
    poses does, because it is the order in which they are solved. Of named sections, the wiring of
    the motors does not count: it changes nothing that is made.
    """
    values = spec.model_dump(mode="json")
    unknown = set(sections) - set(values)
    if unknown:
        raise ValueError(f"no sections {sorted(unknown)} in a spec; there are {list(values)}")
    chosen: dict[str, Any] = {name: values[name] for name in sections or values}
    if sections and "motors" in chosen:
        # Stages hash sections: no hand changes with the numbers on its servos.
        chosen["motors"] = {k: v for k, v in chosen["motors"].items() if k != "wiring"}
    if "poses" in chosen:
        chosen["poses"] = list(chosen["poses"].items())
    text = json.dumps(chosen, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()
