"""The reference of all keys in docs/spec.md, written from the schema.

`python -m fpcad.spec.reference docs/spec.md` brings the document up to date.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator
from dataclasses import fields
from pathlib import Path

from fpcad.spec.catalogue import motor, motor_types
from fpcad.spec.outline import Schema, json_schema, resolved
from fpcad.spec.templates import TEMPLATES
from fpcad.spec.wording import allowed_text

BEGIN = "<!-- reference: written by python -m fpcad.spec.reference -->\n"
END = "<!-- end of reference -->\n"
_UNIT = re.compile(r" ?\[([^\[\],]*)\]")
_HEAD = "| Key | Allowed | Unit | Default | Meaning |\n| --- | --- | --- | --- | --- |\n"


def reference() -> str:
    """Markdown tables of every key of a spec: what it allows, unit, default and meaning."""
    return "\n".join([*_sections("", json_schema()), *_templates(), _motors()])


def with_reference(document: str) -> str:
    """A document with the text between its reference markers brought up to date."""
    before, begin, rest = document.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise ValueError("the document lacks the markers of the reference")
    return f"{before}{BEGIN}\n{reference()}\n{END}{after}"


def _sections(path: str, schema: Schema) -> Iterator[str]:
    title = f"`{path}`" if path else "Top level"
    rows = "".join(
        _row(key, value, key in schema.get("required", ()))
        for key, value in schema["properties"].items()
    )
    yield f"### {title}\n\n{schema.get('description', '')}\n\n{_HEAD}{rows}"
    for key, value in schema["properties"].items():
        yield from _inner(f"{path}.{key}" if path else key, resolved(value))


def _inner(path: str, schema: Schema) -> Iterator[str]:
    """Sections of the mappings that a value holds."""
    if "properties" in schema:
        yield from _sections(path, schema)
    elif "discriminator" in schema:
        tag = schema["discriminator"]
        for name, reference in sorted(tag["mapping"].items()):
            option = resolved({"$ref": reference})
            yield from _sections(f"{path} ({tag['propertyName']}: {name})", option)
    elif "items" in schema:
        yield from _inner(f"{path}[]", resolved(schema["items"]))
    else:
        for value in schema.get("patternProperties", {}).values():
            yield from _inner(f"{path}.NAME", resolved(value))
        if isinstance(schema.get("additionalProperties"), dict):
            yield from _inner(f"{path}.NAME", resolved(schema["additionalProperties"]))


def _templates() -> Iterator[str]:
    """What a spec may refer to by name with each hand template."""
    for name, template in TEMPLATES.items():
        rows = "".join(
            f"| {field.name} | {', '.join(f'`{n}`' for n in getattr(template, field.name))} |\n"
            for field in fields(template)
        )
        yield f"### Names of the template `{name}`\n\n| Kind | Names |\n| --- | --- |\n{rows}"


def _motors() -> str:
    """The catalogue that `motors.type` chooses from, at the supply voltage."""
    head = (
        "| Type | Maker | Supply [V] | Continuous [N m] | Stall [N m] | No load [rad/s] | Mass [g] "
        "| Source |\n" + "| --- " * 8 + "|\n"
    )
    rows = (
        f"| `{m.type}` | {m.maker} | {m.supply_v:g} | {m.continuous_torque_nm:g} "
        f"| {m.stall_torque_nm:g} | {m.no_load_speed_rad_s:g} | {m.mass_g:g} | {m.source} |\n"
        for m in map(motor, motor_types())
    )
    return f"### Motor catalogue, for `motors.type`\n\n{head}{''.join(rows)}"


def _row(key: str, value: Schema, required: bool) -> str:
    schema = resolved(value)
    description = value.get("description", schema.get("description", ""))
    found = _UNIT.search(description)
    unit = found.group(1) if found else ""
    cells = (
        f"`{key}`",
        "a mapping, see below" if "properties" in schema else allowed_text(schema),
        "" if unit == "-" else unit,
        "required" if required else _default(value),
        _UNIT.sub("", description),
    )
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |\n"


def _default(value: Schema) -> str:
    default = value.get("default")
    if default is None:
        return "none"
    if isinstance(default, dict) and default:
        return "see below"
    return f"`{default}`" if isinstance(default, str) and default else f"`{json.dumps(default)}`"


def main(path: str) -> None:
    """Rewrite the reference in the document at `path`."""
    document = Path(path)
    document.write_text(with_reference(document.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1])
