"""A commented spec to start a new design from."""

from __future__ import annotations

import errno
import os
import re
import tempfile
from importlib.resources import files
from pathlib import Path

from fpcad.errors import SpecError
from fpcad.spec.base import NAME_PATTERN
from fpcad.spec.faults import quoted
from fpcad.spec.wording import NAME_WORDS

_NAME_LINE = "name: starter\n"


def write_new(name: str, folder: Path | str) -> Path:
    """Write `folder/name.yaml`, a valid commented spec; never overwrites a file."""
    if re.fullmatch(NAME_PATTERN.strip("^$"), name) is None:
        raise SpecError(f"found {quoted(name)} as a design's name; allowed: {NAME_WORDS}")
    target = Path(folder) / f"{name}.yaml"
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        _write_once(target, starter_text(name))
    except FileExistsError as error:
        message = f"{error.filename}: found a file of this name; allowed: a new name"
        raise SpecError(message) from error
    except OSError as error:
        reason = (error.strerror or "an error").lower()
        message = f"{target}: found {reason}; allowed: a folder that can be written"
        raise SpecError(message) from error
    return target


def starter_text(name: str) -> str:
    """The starting spec under the design's own name."""
    text = (files("fpcad.spec") / "starter.yaml").read_text(encoding="utf-8")
    return text.replace(_NAME_LINE, f"name: {name}\n")


def _write_once(target: Path, text: str) -> None:
    """Write a file whole or not at all; FileExistsError where there is one."""
    if target.exists():
        raise FileExistsError(errno.EEXIST, "File exists", str(target))
    handle, temporary = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as stream:
            stream.write(text)
            stream.flush()
            os.fsync(stream.fileno())
        os.chmod(temporary, 0o644)  # mkstemp makes files that only their owner may read
        os.replace(temporary, target)
    except BaseException:
        os.unlink(temporary)
        raise
