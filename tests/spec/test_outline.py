"""The JSON schema tells editors what the reader allows, and docs/spec.md tells users."""

from __future__ import annotations

from typing import Any

import pytest
from ruamel.yaml import YAML

from fpcad.spec import json_schema
from fpcad.spec.outline import place
from fpcad.spec.reference import reference, with_reference
from tests.spec.base import BASE_TEXT, REPOSITORY, changed

jsonschema = pytest.importorskip("jsonschema")


def test_the_schema_is_one() -> None:
    schema = json_schema()
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    jsonschema.Draft202012Validator.check_schema(schema)


@pytest.mark.parametrize("path", ["designs/clay.yaml", "tests/spec/base.yaml"])
def test_valid_specs_fit_the_schema(path: str) -> None:
    jsonschema.validate(YAML(typ="safe").load(REPOSITORY / path), json_schema())


@pytest.mark.parametrize(
    "edit",
    [
        ("radius_mm: 6", "radus_mm: 6"),
        ("finger: index, link", "finger: indx, link"),
        ("type: STS3215-12V", "type: STS3215"),
        ("  hold:\n    contacts", "  Hold It:\n    contacts"),
        ("kind: sphere", "kind: cube"),
    ],
)
def test_editors_see_faults_too(edit: tuple[str, str]) -> None:
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(YAML(typ="safe").load(changed(edit)), json_schema())


def keys(schema: Any) -> list[tuple[str, Any]]:
    parts = [schema, *schema["$defs"].values()]
    return [item for part in parts for item in part["properties"].items()]


def test_every_key_is_described() -> None:
    defs = json_schema()["$defs"]
    for key, value in keys(json_schema()):
        reference_to = value.get("$ref", "").rpartition("/")[2]
        assert value.get("description") or defs[reference_to]["description"], key


def test_locations_lead_through_unions_without_their_tags() -> None:
    where = place(("hand", "palm", 1, "sphere", "radius_mm"))
    assert where.path == ("hand", "palm", 1, "radius_mm")
    assert where.schema["exclusiveMinimum"] == 0


def test_the_document_is_up_to_date() -> None:
    text = (REPOSITORY / "docs" / "spec.md").read_text(encoding="utf-8")
    assert text == with_reference(text), "run python -m fpcad.spec.reference docs/spec.md"


def test_the_reference_has_every_key() -> None:
    text = reference()
    assert [key for key, _ in keys(json_schema()) if f"| `{key}` |" not in text] == []


def test_a_document_without_markers_is_not_touched() -> None:
    with pytest.raises(ValueError, match="markers"):
        with_reference(BASE_TEXT)
