"""The JSON schema of specs, and the way through it to the part that one value must fit."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

from fpcad.spec.faults import KeyPath
from fpcad.spec.schema import Spec

Schema = dict[str, Any]
DIALECT = "https://json-schema.org/draft/2020-12/schema"


class Place(NamedTuple):
    """A place of the spec that a validation error points to."""

    path: KeyPath
    schema: Schema
    """What the value there must fit; empty where the path leaves the schema."""
    parent: Schema
    """What the mapping or list around it must fit."""


def json_schema() -> Schema:
    """JSON schema of spec files (draft 2020-12) with descriptions, for editors."""
    schema = Spec.model_json_schema()
    for part in (schema, *schema["$defs"].values()):
        for value in part["properties"].values():
            if "patternProperties" in value:  # other keys are faults, as `fpcad validate` says
                value["additionalProperties"] = False
    return {"$schema": DIALECT, **schema, "title": "fpcad spec"}


@cache
def _root() -> Schema:
    return json_schema()


def resolved(schema: Schema) -> Schema:
    """A part of the spec's schema with its reference followed and `or null` taken off."""
    if "anyOf" in schema:
        (schema,) = [option for option in schema["anyOf"] if option.get("type") != "null"]
    if "$ref" in schema:
        return _root()["$defs"][schema["$ref"].rpartition("/")[2]]
    return schema


def place(location: KeyPath) -> Place:
    """The place that a location names; union tags, which are no keys of the file, are left out."""
    schema, parent, path = _root(), {}, ()
    for part in location:
        options = schema.get("discriminator", {}).get("mapping", {})
        if part in options:
            schema = resolved({"$ref": options[part]})
            continue
        parent, path = schema, (*path, part)
        schema = resolved(_child(schema, part))
    return Place(path, schema, parent)


def _child(schema: Schema, part: str | int) -> Schema:
    if isinstance(part, int):
        fixed = schema.get("prefixItems", [])
        return fixed[part] if part < len(fixed) else schema.get("items", {})
    if part in schema.get("properties", {}):
        return schema["properties"][part]
    for value in schema.get("patternProperties", {}).values():
        return value
    others = schema.get("additionalProperties")
    return others if isinstance(others, dict) else {}
