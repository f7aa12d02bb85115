"""Faults of YAML syntax and encoding in plain words."""

from __future__ import annotations

import re

from ruamel.yaml.error import YAMLError, YAMLStreamError

from fpcad.spec.faults import Fault, quoted

MAX_BYTES = 256 * 1024
"""Largest spec file; a spec with many poses has some ten thousand bytes."""

_WORDS: tuple[tuple[str, str, str], ...] = (
    ("mapping values are not allowed", 'a ":" where no key can stand', "`key: value`, one a line"),
    ("could not find expected ':'", 'a key without ":"', "`key: value`"),
    ("expected ',' or '}'", "a `{` mapping that does not close", "`{key: value, key: value}`"),
    ("expected ',' or '\\]'", "a `[` list that does not close", "`[value, value]`"),
    ("unexpected end of stream", "a quoted text that does not end", "a closing quote"),
    ("expected <block end>", "an entry that does not line up", "the indentation above"),
    ("block sequence entries are not", 'a "-" where no list item can stand', "`- item` lines"),
    ("unknown escape character", "an unknown escape after a backslash", "an escape such as \\n"),
    ("undefined tag handle", "an unknown tag", "values without tags"),
    ("duplicate anchor", "the same anchor twice", "each anchor once"),
)


def syntax_fault(error: YAMLError | YAMLStreamError, text: str, file: str) -> Fault:
    """The fault that a YAML parser's error tells of."""
    mark = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
    if mark is None:
        return _unreadable_character(error, text, file)
    line, column = mark.line + 1, mark.column + 1
    rest = mark_line(text, mark.line)[mark.column :]
    problem = str(getattr(error, "problem", None) or "broken YAML")
    if rest.startswith("\t"):
        return Fault(file, line, column, "", "a tab", "spaces for indentation")
    for pattern, found, allowed in _WORDS:
        if re.search(pattern, problem):
            return Fault(file, line, column, "", found, allowed)
    what = quoted(rest[:20]) if rest.strip() else " ".join(problem.split())
    return Fault(file, line, column, "", f"{what}, where YAML expects something else", "YAML 1.2")


def mark_line(text: str, index: int) -> str:
    """A line of the text by the line breaks that the parser counts, from 0; empty past the end."""
    lines = re.split("\r\n|[\r\n\x85\u2028\u2029]", text)
    return lines[index] if index < len(lines) else ""


def decode(data: bytes, file: str) -> str | Fault:
    """The text of a spec file's bytes, or the fault that keeps it from being read."""
    if len(data) > MAX_BYTES:
        return Fault(file, 1, 1, "", f"a file of more than {MAX_BYTES} bytes", "a smaller file")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        before = error.object[: error.start].decode("utf-8")
        line, column = _place(before)
        found = f"the byte 0x{error.object[error.start]:02x}"
        return Fault(file, line, column, "", found, "text encoded in UTF-8")


def _unreadable_character(error: Exception, text: str, file: str) -> Fault:
    """The reader names the first character that YAML forbids by its position only."""
    position = getattr(error, "position", 0)
    line, column = _place(text[:position])
    character = text[position : position + 1]
    return Fault(
        file, line, column, "", f"the character U+{ord(character or chr(0)):04X}", "printable text"
    )


def _place(before: str) -> tuple[int, int]:
    return before.count("\n") + 1, len(before) - (before.rfind("\n") + 1) + 1
