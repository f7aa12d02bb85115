"""pydantic's complaints about a document as faults in the user's terms."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic import ValidationError

from fpcad.spec.document import Document
from fpcad.spec.faults import Fault, KeyPath, key_text, keys_allowed, one_of, quoted
from fpcad.spec.outline import Place, place
from fpcad.spec.wording import NAME_WORDS, allowed_text, found_text


def schema_faults(document: Document, error: ValidationError) -> Iterator[Fault]:
    """One fault for each thing that the schema does not allow."""
    for detail in error.errors(include_url=False, include_input=False):
        translation = _Translation(document, detail)
        if not translation.is_consequence:
            yield translation.fault()


class _Translation:
    def __init__(self, document: Document, detail: Any) -> None:
        self._document = document
        self._kind: str = detail["type"]
        self._context: dict[str, Any] = detail.get("ctx", {})
        self._message: str = detail["msg"]
        self._location: KeyPath = detail["loc"]

    @property
    def is_consequence(self) -> bool:
        """Whether pydantic counts a list or mapping as too short because its items are faulty."""
        if self._kind != "too_short":
            return False
        node = self._document.node(place(self._location).path)
        given = len(node.value) if node and isinstance(node.value, (dict, list)) else 0
        return given >= self._context["min_length"]

    def fault(self) -> Fault:
        if self._location and self._location[-1] == "[key]":
            path = place(self._location[:-1]).path
            return self._at_key(path, f"the name {quoted(str(path[-1]))}", NAME_WORDS)
        where = place(self._location)
        if self._kind == "extra_forbidden":
            return self._unknown_key(where)
        if self._kind == "missing":
            return self._missing(where)
        if self._kind in ("union_tag_invalid", "union_tag_not_found"):
            return self._wrong_tag(where)
        if self._kind in ("value_error", "fault"):
            return self._rejected(where)
        return self._at_value(where.path, self._allowed(where))

    def _unknown_key(self, where: Place) -> Fault:
        key = str(where.path[-1])
        parent = self._document.node(where.path[:-1])
        used = parent.value if parent is not None and isinstance(parent.value, dict) else ()
        allowed = keys_allowed(where.parent["properties"], key, used)
        return self._at_key(where.path, f"unknown key {quoted(key)}", allowed)

    def _missing(self, where: Place) -> Fault:
        if isinstance(where.path[-1], int):  # too few items: a fault of the list
            return self._at_value(where.path[:-1], allowed_text(where.parent))
        return missing_key(self._document, where.path, allowed_text(where.schema))

    def _wrong_tag(self, where: Place) -> Fault:
        tag = where.schema["discriminator"]
        path = (*where.path, tag["propertyName"])
        node = self._document.node(path)
        if node is None:
            return missing_key(self._document, path, one_of(tag["mapping"]))
        found = node.value if isinstance(node.value, str) else None
        return self._at_value(path, one_of(tag["mapping"], found))

    def _rejected(self, where: Place) -> Fault:
        path = (*where.path, self._context["at"]) if self._context.get("at") else where.path
        return self._at_value(path, self._message.removeprefix("Value error, "))

    def _allowed(self, where: Place) -> str:
        node = self._document.node(where.path)
        words = allowed_text(where.schema, node.value if node else None)
        if self._kind == "finite_number":
            return words.replace("a number", "a finite number")
        return words

    def _at_value(self, path: KeyPath, allowed: str) -> Fault:
        mark, node = self._document.value_mark(path), self._document.node(path)
        found = found_text(node) if node is not None else "nothing"
        return Fault(self._document.file, *mark, key_text(path), found, allowed)

    def _at_key(self, path: KeyPath, found: str, allowed: str) -> Fault:
        mark = self._document.key_mark(path)
        return Fault(self._document.file, *mark, key_text(path), found, allowed)


def missing_key(document: Document, path: KeyPath, allowed: str) -> Fault:
    """The fault of a key that is not there; it points to the mapping that lacks it."""
    mark = document.key_mark(path[:-1])
    return Fault(document.file, *mark, key_text(path), "no such key", allowed)
