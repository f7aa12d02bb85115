"""XML documents with numbers of full precision."""

from __future__ import annotations

import xml.etree.ElementTree as ET


def number(value: float) -> str:
    """A number with all its digits; -0.0 is written as 0.0."""
    return repr(float(value) + 0.0)


def document(root: ET.Element, remark: str = "") -> str:
    """Text of a document, indented; the remark stands as a comment before its root."""
    ET.indent(root)
    comment = f"<!-- {remark} -->\n" if remark else ""
    return f'<?xml version="1.0"?>\n{comment}{ET.tostring(root, encoding="unicode")}\n'
