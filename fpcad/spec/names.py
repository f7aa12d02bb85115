"""Mappings whose keys are given by another part of the spec."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from fpcad.spec.faults import KeyPath, keys_allowed, quoted
from fpcad.spec.parts import Finding, Parts


def check_exact_keys(
    parts: Parts, path: KeyPath, names: Sequence[str], allowed: str
) -> Iterator[Finding]:
    """Findings for keys beyond `names` and for names without a key, whose value is `allowed`."""
    keys = parts.keys(path)
    if keys is None:
        return
    for key in keys:
        if key not in names:
            words = keys_allowed(names, key, used=keys)
            yield Finding((*path, key), words, f"unknown key {quoted(key)}", "key")
    for name in names:
        if name not in keys:
            yield Finding((*path, name), allowed, "no such key", "parent")


def span(interval: tuple[float, float]) -> str:
    """A range as users write it."""
    return f"[{interval[0]:g}, {interval[1]:g}]"
