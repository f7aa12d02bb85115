"""YAML text to a tree of plain values that know their place in the file.

The tree is built from ruamel.yaml's parse events rather than by its constructors: so every
duplicate key is found, nothing but plain data can arise, and depth and size are bounded before
they cost memory.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError, YAMLStreamError
from ruamel.yaml.events import (
    AliasEvent,
    DocumentStartEvent,
    MappingEndEvent,
    MappingStartEvent,
    ScalarEvent,
    SequenceEndEvent,
    SequenceStartEvent,
)
from ruamel.yaml.nodes import ScalarNode
from ruamel.yaml.resolver import VersionedResolver

from fpcad.spec.faults import Fault, KeyPath, key_text, quoted
from fpcad.spec.scalars import Scalar, scalar_value
from fpcad.spec.syntax import syntax_fault

MAX_DEPTH = 30
"""Deepest nesting of lists and mappings; a spec needs less than ten."""
MAX_VALUES = 20_000
"""Most values of a file, aliases counted as often as they are used."""


class Mark(NamedTuple):
    """A place in the file, both counted from 1."""

    line: int
    column: int


@dataclass
class Node:
    """A value of the file."""

    mark: Mark
    value: Scalar | list[Node] | dict[str, Entry]
    text: str = ""
    """A scalar as it is written, without quotes."""
    size: int = 1
    """Number of values in it, itself included."""

    @property
    def plain(self) -> Any:
        """The value as dicts, lists and scalars."""
        if isinstance(self.value, dict):
            return {key: entry.node.plain for key, entry in self.value.items()}
        if isinstance(self.value, list):
            return [node.plain for node in self.value]
        return self.value


class Entry(NamedTuple):
    """A mapping's value together with its key's place."""

    key_mark: Mark
    node: Node


@dataclass
class Document:
    """A YAML file: its root, if it could be read, and the faults of its form."""

    file: str
    root: Node | None = None
    faults: list[Fault] = field(default_factory=list)

    def node(self, path: KeyPath) -> Node | None:
        """The value at a path, or None where there is none."""
        node = self.root
        for part in path:
            node = _child(node, part)
        return node

    def value_mark(self, path: KeyPath) -> Mark:
        """Place of a value, or of the nearest one around it."""
        for end in range(len(path), -1, -1):
            node = self.node(path[:end])
            if node is not None:
                return node.mark
        return Mark(1, 1)

    def key_mark(self, path: KeyPath) -> Mark:
        """Place of a value's key, or of the value itself in a list and at the top."""
        parent = self.node(path[:-1]) if path else None
        if parent is not None and isinstance(parent.value, dict) and path[-1] in parent.value:
            return parent.value[str(path[-1])].key_mark
        return self.value_mark(path)


class _FormError(Exception):
    """The form of the file makes it senseless to read on."""

    def __init__(self, mark: Mark, path: KeyPath, found: str, allowed: str) -> None:
        super().__init__(mark, path, found, allowed)
        self.mark, self.path, self.found, self.allowed = mark, path, found, allowed


def read_document(text: str, file: str) -> Document:
    """Parse YAML 1.2; faults of syntax and form are collected, not raised."""
    document = Document(file)
    builder = _Builder(document, YAML(typ="safe", pure=True).parse(text))
    try:
        document.root = builder.build()
    except _FormError as error:
        key = key_text(error.path)
        document.faults.append(Fault(file, *error.mark, key, error.found, error.allowed))
    except (YAMLError, YAMLStreamError) as error:
        document.faults.append(syntax_fault(error, text, file))
    return document


def _child(node: Node | None, part: str | int) -> Node | None:
    if node is None:
        return None
    if isinstance(node.value, dict) and isinstance(part, str):
        return node.value[part].node if part in node.value else None
    if isinstance(node.value, list) and isinstance(part, int):
        return node.value[part] if 0 <= part < len(node.value) else None
    return None


def _mark(event: Any) -> Mark:
    return Mark(event.start_mark.line + 1, event.start_mark.column + 1)


class _Builder:
    """Recursive descent over parse events; the depth limit bounds the recursion."""

    def __init__(self, document: Document, events: Iterator[Any]) -> None:
        self._document = document
        self._events = events
        self._anchors: dict[str, Node] = {}
        self._resolver = VersionedResolver(version=(1, 2))
        self._count = 0

    def build(self) -> Node | None:
        """Root of the first document, None where the file holds none; a second one is a fault."""
        root, documents = None, 0
        for event in self._events:
            if isinstance(event, DocumentStartEvent):
                documents += 1
                if documents > 1:
                    raise _FormError(_mark(event), (), "a second YAML document", "one document")
                if event.version not in (None, (1, 2)):
                    version = ".".join(map(str, event.version))
                    raise _FormError(_mark(event), (), f"YAML {version}", "YAML 1.2")
                root = self._node(next(self._events), ())
        return root

    def _node(self, event: Any, path: KeyPath) -> Node:
        mark = _mark(event)
        if len(path) > MAX_DEPTH:
            raise _FormError(mark, (), "nesting too deep to be a spec", f"{MAX_DEPTH} levels")
        if isinstance(event, AliasEvent):
            return self._counted(self._alias(event, path), mark, path)
        if event.tag is not None:
            tag = quoted(str(event.tag).replace("tag:yaml.org,2002:", "!!"))
            self._fault(mark, path, f"the tag {tag}", "values without tags")
        if isinstance(event, MappingStartEvent):
            node = self._mapping(mark, path)
        elif isinstance(event, SequenceStartEvent):
            node = self._sequence(mark, path)
        else:
            node = self._counted(self._scalar(event, path), mark, path)
        if event.anchor is not None:
            self._anchors[str(event.anchor)] = node
        return node

    def _alias(self, event: Any, path: KeyPath) -> Node:
        node = self._anchors.get(str(event.anchor))
        if node is None:
            found = f'the alias "*{event.anchor}"'
            raise _FormError(_mark(event), path, found, "an alias of an anchor that stands before")
        return Node(node.mark, node.value, node.text, node.size)

    def _counted(self, node: Node, mark: Mark, path: KeyPath) -> Node:
        self._count += node.size
        if self._count > MAX_VALUES:
            found = f"more than {MAX_VALUES} values, repeated ones counted"
            raise _FormError(mark, path, found, f"at most {MAX_VALUES}")
        return node

    def _sequence(self, mark: Mark, path: KeyPath) -> Node:
        items: list[Node] = []
        while not isinstance(event := next(self._events), SequenceEndEvent):
            items.append(self._node(event, (*path, len(items))))
        return Node(mark, items, size=1 + sum(item.size for item in items))

    def _mapping(self, mark: Mark, path: KeyPath) -> Node:
        entries: dict[str, Entry] = {}
        while not isinstance(event := next(self._events), MappingEndEvent):
            key = self._key(event, path)
            node = self._node(next(self._events), (*path, key or "?"))
            if key in entries:
                first = entries[key].key_mark
                found = f"the key {quoted(key)} again"
                allowed = f"each key once (first in line {first.line})"
                self._fault(_mark(event), (*path, key), found, allowed)
            elif key is not None:
                if node.value is None and not node.text:  # nothing there: the key is the place
                    node.mark = _mark(event)
                entries[key] = Entry(_mark(event), node)
        return Node(mark, entries, size=1 + sum(entry.node.size for entry in entries.values()))

    def _key(self, event: Any, path: KeyPath) -> str | None:
        if not isinstance(event, ScalarEvent):
            found = "a list, a mapping or an alias as a key"
            raise _FormError(_mark(event), path, found, "a name as a key")
        key = self._scalar(event, path)
        if isinstance(key.value, str):
            return key.value
        self._fault(key.mark, path, f"{key.text or 'nothing'} as a key", "a name as a key")
        return None

    def _scalar(self, event: Any, path: KeyPath) -> Node:
        mark, text = _mark(event), event.value
        tag = str(self._resolver.resolve(ScalarNode, text, event.implicit)).rpartition(":")[2]
        if tag == "str" and any("\ud800" <= c <= "\udfff" for c in text):
            self._fault(mark, path, quoted(text), "text in Unicode without surrogates")
            return Node(mark, "", text)
        return Node(mark, scalar_value(tag, text), text)

    def _fault(self, mark: Mark, path: KeyPath, found: str, allowed: str) -> None:
        self._document.faults.append(
            Fault(self._document.file, *mark, key_text(path), found, allowed)
        )
