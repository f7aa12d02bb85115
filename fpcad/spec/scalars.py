"""Plain scalars of YAML 1.2."""

from __future__ import annotations

MAX_DIGITS = 40
"""Longest whole number that is kept exactly; Python refuses to read endless ones."""

Scalar = str | int | float | bool | None


def scalar_value(tag: str, text: str) -> Scalar:
    """A plain scalar by its tag's last word; dates and merge keys are just text to us."""
    if tag not in ("int", "float", "bool", "null"):
        return text
    if tag == "bool":
        return text.lower() == "true"
    if tag == "null":
        return None
    try:
        return _number(tag, text.replace("_", "").lower())
    except ValueError:  # the resolver also takes `.` and `0x_` for numbers
        return text


def _number(tag: str, digits: str) -> int | float:
    if tag == "int" and len(digits) <= MAX_DIGITS:
        based = digits.lstrip("+-")[:2] in ("0x", "0o", "0b")
        return int(digits, 0 if based else 10)
    return float(digits.replace(".inf", "inf").replace(".nan", "nan"))
