"""Reading and checking spec files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from fpcad.errors import SpecError
from fpcad.spec.checks import cross_check
from fpcad.spec.document import Document, read_document
from fpcad.spec.faults import Fault, sorted_faults
from fpcad.spec.parts import Parts
from fpcad.spec.schema import Spec
from fpcad.spec.syntax import MAX_BYTES, decode
from fpcad.spec.translate import schema_faults


def load_spec(path: Path | str) -> Spec:
    """Read and check a spec file; :class:`fpcad.errors.SpecError` lists every fault, one a line."""
    spec, faults = _read(Path(path))
    if spec is None or faults:
        raise SpecError("\n".join(map(str, faults)))
    return spec


def find_faults(path: Path | str) -> list[Fault]:
    """Every fault of a spec file in the order of its lines; empty for a valid one."""
    return _read(Path(path))[1]


def parse_spec(text: str, file: str = "spec") -> tuple[Spec | None, list[Fault]]:
    """A spec from YAML text and all of its faults; None where it cannot be built."""
    document = read_document(text, file)
    if document.root is None:
        empty = Fault(file, 1, 1, "", "an empty file", "a spec (`fpcad new NAME` writes one)")
        return None, sorted_faults(document.faults or [empty])
    spec, faults = _validate(document, document.root.plain)
    return spec, sorted_faults([*document.faults, *faults])


def _validate(document: Document, values: Any) -> tuple[Spec | None, list[Fault]]:
    findings = [finding.fault(document) for finding in cross_check(Parts(document))]
    try:
        # As JSON, because pydantic's strict mode then takes lists for tuples and nothing else.
        spec = Spec.model_validate_json(json.dumps(values), strict=True)
    except ValidationError as error:
        return None, [*schema_faults(document, error), *findings]
    return spec, findings


def _read(path: Path) -> tuple[Spec | None, list[Fault]]:
    file = str(path)
    try:
        with path.open("rb") as stream:
            data = stream.read(MAX_BYTES + 1)
    except OSError as error:
        found = (error.strerror or "an error").lower()
        return None, [Fault(file, 1, 1, "", found, "a file that can be read")]
    text = decode(data, file)
    if isinstance(text, Fault):
        return None, [text]
    return parse_spec(text, file)
