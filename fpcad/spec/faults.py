"""Faults of a spec file: where, what was found, what is allowed."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable
from dataclasses import dataclass

KeyPath = tuple[str | int, ...]
"""Keys and list positions that lead from the top of a spec to one of its values."""


@dataclass(frozen=True)
class Fault:
    """One fault of a spec file; its text is one line."""

    file: str
    line: int
    """Line of the file, from 1."""
    column: int
    """Column of the line, from 1."""
    key: str
    """Key path such as `poses.grip.contacts[0].finger`; empty for the file as a whole."""
    found: str
    allowed: str

    def __str__(self) -> str:
        key = f" {self.key}" if self.key else ""
        place = f"{self.file}:{self.line}:{self.column}{key}"
        return f"{place}: found {self.found}; allowed: {self.allowed}"


def sorted_faults(faults: Iterable[Fault]) -> list[Fault]:
    """Faults in the order of the file, each once."""
    return sorted(set(faults), key=lambda f: (f.line, f.column, f.key, f.found, f.allowed))


def key_text(path: KeyPath) -> str:
    """A key path as users write it: `poses.grip.contacts[0].finger`."""
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f"[{part}]"
        else:
            plain = re.fullmatch(r"[\w<-]+", part) is not None
            text += ("." if text else "") + (part if plain else quoted(part))
    return text


def quoted(text: str, longest: int = 60) -> str:
    """Text in double quotes on one line, with control characters escaped and the end cut."""
    if len(text) > longest:
        text = text[: longest - 3] + "..."
    escaped = (c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)
    return '"' + "".join(escaped) + '"'


def one_of(names: Iterable[object], found: str | None = None) -> str:
    """`one of a, b, c`, with the name that is nearest to the one found."""
    known = [str(name) for name in names]  # a list of choices may hold numbers
    words = "one of " + ", ".join(known) if len(known) > 1 else ", ".join(known) or "nothing"
    return words + near_miss(known, found)


def keys_allowed(names: Iterable[str], found: str | None = None, used: Iterable[str] = ()) -> str:
    """`keys a, b, c`, with the nearest one that is not in use yet."""
    known, taken = list(names), set(used)
    return "keys " + ", ".join(known) + near_miss([k for k in known if k not in taken], found)


def near_miss(known: Iterable[str], found: str | None) -> str:
    """` (did you mean "x"?)` where a known name is close to the one found, else nothing."""
    if found is None:
        return ""
    by_lower = {name.lower(): name for name in known}
    close = difflib.get_close_matches(found.lower(), list(by_lower), n=1, cutoff=0.6)
    return f' (did you mean "{by_lower[close[0]]}"?)' if close else ""
