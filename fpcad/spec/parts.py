"""The parts of a document that are valid on their own, for checks across parts."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any, Literal, TypeVar

from pydantic import TypeAdapter, ValidationError

from fpcad.spec.base import Interval, Vector3
from fpcad.spec.document import Document
from fpcad.spec.faults import Fault, KeyPath, key_text
from fpcad.spec.hand import PalmCapsule, PalmPrimitive, PalmSphere
from fpcad.spec.pose import CostTerm, JointUse, OpposedNormals, TurningNormals
from fpcad.spec.wording import found_text

T = TypeVar("T")

INTERVAL: TypeAdapter[tuple[float, float]] = TypeAdapter(Interval)
VECTOR3: TypeAdapter[tuple[float, float, float]] = TypeAdapter(Vector3)
PALM_PRIMITIVE: TypeAdapter[PalmCapsule | PalmSphere] = TypeAdapter(PalmPrimitive)
COST_TERM: TypeAdapter[TurningNormals | OpposedNormals | JointUse] = TypeAdapter(CostTerm)


@dataclass(frozen=True)
class Finding:
    """What a check found at a path of the document."""

    path: KeyPath
    allowed: str
    found: str | None = None
    """Words for what was found; the value itself when None."""
    at: Literal["value", "key", "parent"] = "value"
    """Where users should look: parent where a key is missing."""

    def fault(self, document: Document) -> Fault:
        """The finding with its place in the file."""
        if self.at == "value":
            mark = document.value_mark(self.path)
        else:
            mark = document.key_mark(self.path if self.at == "key" else self.path[:-1])
        node = document.node(self.path)
        found = self.found or (found_text(node) if node is not None else "no such key")
        return Fault(document.file, *mark, key_text(self.path), found, self.allowed)


class Parts:
    """Typed access to a document: a part that is missing or faulty in itself reads as None.

    So checks across parts run on whatever is sound, and say nothing twice.
    """

    def __init__(self, document: Document) -> None:
        self._document = document

    def get(self, path: KeyPath, kind: type[T] | TypeAdapter[T]) -> T | None:
        """The part at a path as a value of `kind`, or None."""
        node = self._document.node(path)
        if node is None:
            return None
        try:
            adapter = kind if isinstance(kind, TypeAdapter) else _adapter(kind)
            return adapter.validate_json(json.dumps(node.plain), strict=True)
        except ValidationError:  # told by the schema's own faults
            return None

    def get_or(self, path: KeyPath, kind: type[T], default: T) -> T | None:
        """The part at a path, its default where it is left out, or None where it is faulty."""
        return default if self._document.node(path) is None else self.get(path, kind)

    def keys(self, path: KeyPath) -> list[str] | None:
        """Keys of the mapping at a path, or None where there is no mapping."""
        node = self._document.node(path)
        return list(node.value) if node is not None and isinstance(node.value, dict) else None

    def entries(
        self, path: KeyPath, kind: type[T] | TypeAdapter[T]
    ) -> Iterator[tuple[KeyPath, str, T]]:
        """Path, key and value of each sound entry of the mapping at a path."""
        for key in self.keys(path) or ():
            value = self.get((*path, key), kind)
            if value is not None:
                yield (*path, key), key, value

    def items(
        self, path: KeyPath, kind: type[T] | TypeAdapter[T]
    ) -> list[tuple[KeyPath, T | None]]:
        """Path and value of each item of the list at a path, None for faulty ones."""
        return [(item, self.get(item, kind)) for item in self.positions(path)]

    def positions(self, path: KeyPath) -> list[KeyPath]:
        """Paths of the items of the list at a path; none where there is no list."""
        node = self._document.node(path)
        count = len(node.value) if node is not None and isinstance(node.value, list) else 0
        return [(*path, i) for i in range(count)]


@cache
def _adapter(kind: type[Any]) -> TypeAdapter[Any]:
    return TypeAdapter(kind)
