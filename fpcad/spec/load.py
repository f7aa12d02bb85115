"""Reading a spec from YAML."""

from __future__ import annotations

from pathlib import Path

from ruamel.yaml import YAML

from fpcad.spec.schema import Spec


def load_spec(path: Path | str) -> Spec:
    """Read and check a spec file; raises :class:`fpcad.errors.SpecError` listing all faults."""
    return Spec.model_validate(YAML(typ="safe").load(Path(path).read_text(encoding="utf-8")))
