"""Plain words for values that were found and for what a place of the spec allows.

What is allowed is read from the JSON schema, so that messages, editors and docs/spec.md say the
same, and no validator's jargon reaches users.
"""

from __future__ import annotations

from typing import Any

from fpcad.spec.base import NAME_PATTERN
from fpcad.spec.document import Node
from fpcad.spec.faults import one_of, quoted

Schema = dict[str, Any]

NAME_WORDS = "a name of lower-case letters, digits, - and _ that starts with a letter (at most 40)"
_PATTERNS = {NAME_PATTERN: NAME_WORDS}
_LONGEST = 60


def found_text(node: Node) -> str:
    """A value as it stands in the file, on one line and cut where it is long."""
    if isinstance(node.value, str):
        return quoted(node.text)
    if node.value is None and not node.text:
        return "nothing"
    text = _inline(node) if isinstance(node.value, (dict, list)) else node.text
    return text if len(text) <= _LONGEST else text[: _LONGEST - 3] + "..."


def _inline(node: Node, room: int = _LONGEST) -> str:
    """A list or mapping in flow style; stops early, the caller cuts what is too long."""
    if isinstance(node.value, list):
        parts: list[str] = []
        for item in node.value:
            if sum(map(len, parts)) > room:
                break
            parts.append(_inline(item, room))
        return "[" + ", ".join(parts) + "]"
    if isinstance(node.value, dict):
        parts = []
        for key, entry in node.value.items():
            if sum(map(len, parts)) > room:
                break
            parts.append(f"{quoted(key)[1:-1]}: {_inline(entry.node, room)}")
        return "{" + ", ".join(parts) + "}"
    return quoted(node.text)[1:-1] or ('""' if isinstance(node.value, str) else "")


def allowed_text(schema: Schema, found: Any = None) -> str:
    """What a resolved part of the JSON schema allows, with a near miss for a text found."""
    if "const" in schema:
        return str(schema["const"])
    if "enum" in schema:
        return one_of(schema["enum"], found if isinstance(found, str) else None)
    if "discriminator" in schema:
        tag = schema["discriminator"]
        return f"a mapping with {tag['propertyName']}: {one_of(tag['mapping'])}"
    kind = schema.get("type")
    if kind in ("number", "integer"):
        return ("a number" if kind == "number" else "a whole number") + _bounds(schema)
    if kind == "array":
        return _array(schema)
    if kind == "object":
        return _object(schema)
    if kind == "boolean":
        return "true or false"
    return _PATTERNS.get(schema.get("pattern", ""), "text")


def _bounds(schema: Schema) -> str:
    if "minimum" in schema and "maximum" in schema:
        return f" from {schema['minimum']} to {schema['maximum']}"
    limits = [
        (f"{words} {schema[key]:g}" if abs(schema[key]) < 1e6 else f"{words} {schema[key]}")
        for key, words in (
            ("exclusiveMinimum", "greater than"),
            ("minimum", "at least"),
            ("exclusiveMaximum", "less than"),
            ("maximum", "at most"),
        )
        if key in schema
    ]
    words = " and ".join(limits)
    return (" of " if words.startswith("at ") else " ") + words if words else ""


def _array(schema: Schema) -> str:
    items = schema.get("prefixItems")
    if items is None:
        least = schema.get("minItems", 0)
        return (
            f"a list of at least {least} items"
            if least > 1
            else ("a list of at least 1 item" if least else "a list")
        )
    if len(items) == 2 and items[0].get("type") == "number":
        return "a range [low, high] of two numbers"
    return f"a list of {len(items)} {'numbers' if items[0]['type'] == 'number' else 'names'}"


def _object(schema: Schema) -> str:
    if "properties" in schema:
        return "a mapping with keys " + ", ".join(schema["properties"])
    return "a mapping with at least 1 entry" if schema.get("minProperties") else "a mapping"
